"""Reasons of differences, and the table of slow motions, on the page of `benchmarks.openfast_decks`."""

REASONS = """\
- Pitch decays: strips turn with the body here, and keep the axes of the upright platform in OpenFAST. The deck read back has
  the axes of the deck.
- Regular waves, surge and pitch: OpenFAST has MacCamy and Fuchs' force for one diameter, without its phase. Other columns have
  Morison's 1 + Ca there.
- Seas, surge: slow motions. Near the surface HydroDyn spreads the load of the piece at the surface over two nodes, which
  changes mean and slow forces by some 0.1 % of the wave force. Without stretching on both sides, VolturnUS-S read back differs
  in the sea by 3.2 % in surge, 0.4 % in heave and 1.2 % in pitch (rms), and OC3-Hywind in the regular wave by 0.1 % in surge.
- OC3-Hywind's heave of the deck read back was made before `jaxhydro convert` read AxCa and AxCd along a taper. With them the
  deck read back has OpenFAST's period in the decay within 0.001 %. Its standard deviations differ by +0.04 % in the
  regular wave and +0.02 % in the sea.
- Catenaries and tendons: MoorDyn's lines have inertia, added mass and drag.
- OC3 monopile: turned by 1e-4 rad about the mudline it rings at 0.12 s. Its pitch differs over 10 s by 8.8 % of the offset with
  DT of 0.005 s, 2.2 % with the deck's 0.0025 s and 0.4 % with 0.00125 s."""

ON_LINES = (
    "The deck of VolturnUS-S with potential flow and three chains of the reference runs, in a sea of Hs 3.1 m and Tp 8.96 s "
    "for one hour. Standard deviations are those below 0.05 Hz and above. With a matrix in place of the lines, OpenFAST's slow "
    "motions are those of this package within 2.5 %. MoorDyn's lines damp them: mostly by drag and added mass, partly by their "
    "inertia. Made by `python -m benchmarks.openfast_lines OPENFAST DECK FOLDER`."
)
LINES_HEAD = (
    *("run", "mean surge (m)", "slow surge (m)", "slow heave (m)", "slow pitch (deg)"),
    *("surge at the waves' frequencies (m)", "heave (m)", "pitch (deg)"),
)
LINES = {
    "original": "OpenFAST, the deck itself",
    "moordyn": "OpenFAST, converted and exported",
    "thin": "OpenFAST, lines without drag and added mass",
    "matrix": "OpenFAST, a matrix in place of the lines",
    "here_platform": "here, catenaries in static balance",
    "here_matrix": "here, the same matrix",
}
