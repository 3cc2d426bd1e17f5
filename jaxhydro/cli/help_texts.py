"""Help texts of the command line: what it is for, examples, and what each command writes."""

HELP = (
    "Motions of floating-wind platforms in waves, and the coefficients that make them follow a basin test.\n\n"
    "A platform is one YAML file: hull members, mass, mooring, starting coefficients. A campaign is a folder: that "
    "file, a campaign.yaml that says what was measured in which columns, and one data file per test."
)
EPILOG = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro demo --out demo",
        "jaxhydro simulate volturnus-s --hs 3.1 --tp 8.96 --out sea",
        "jaxhydro simulate volturnus-s --release surge=5 --release pitch=3 --out decay",
        "jaxhydro sweep sweep.yaml --out life",
        "jaxhydro convert deck/main.fst --out my-platform",
        "jaxhydro init my-campaign decays/*.csv --scale 70",
        "jaxhydro calibrate my-campaign --out results",
        "jaxhydro uncertainty my-campaign --calibration results/calibration.json --out uncertainty",
        "jaxhydro diagnose my-campaign --out diagnosis",
        "[bold]Formats[/bold]",
        "docs/formats.md describes every key of platform and campaign files, and of the results. `jaxhydro init` makes a "
        "campaign to fill in; `jaxhydro demo` prints where a complete one is.",
        "Exit status: 0 done; 2 the input is wrong; 3 not converged, or runs of a sweep failed; 130 stopped. With 3, what "
        "was reached is written and marked so. If a motion grew beyond all bounds, nothing is written.",
    )
)
EXAMPLES = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro simulate volturnus-s --hs 3.1 --tp 8.96 --duration 3600 --out sea",
        "jaxhydro simulate volturnus-s --hs 3.1 --tp 8.96 --spreading 10 --out short-crested",
        "jaxhydro simulate volturnus-s --sea 'hs=2 tp=14 heading=30' --sea 'hs=1.5 tp=7 heading=-40 spreading=8' --out two",
        "jaxhydro simulate volturnus-s --wave tank.csv --wave-column probe1 --wave-position -100 0 --out tank",
        "jaxhydro simulate volturnus-s --wave tank.csv --wave-column probe1 --wave-position -100 0 --second-wave-column probe2 "
        "--second-wave-position -80 0 --out both",
        "jaxhydro simulate volturnus-s --wave-height 4 --wave-period 10 --out wave",
        "jaxhydro simulate volturnus-s --release surge=5 --release pitch=3 --out decay",
        "jaxhydro simulate volturnus-s --release surge=5 --format netcdf --format outb --out files",
        "jaxhydro simulate my-campaign --calibration results/calibration.json --out seas",
    )
)
CONVERTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro convert deck/main.fst --out my-platform",
        "jaxhydro convert nemoh-case --out my-platform --mooring moordyn.dat",
        "jaxhydro convert moordyn.dat --out my-lines",
        "jaxhydro simulate my-platform/platform.yaml --release heave=1",
        "[bold]What it writes[/bold]",
        "platform.yaml, copies of the tables that it names, and conversion.md: what was taken, approximated, left out, and "
        "what to fill in. Of mooring lines alone, mooring.yaml in place of platform.yaml. "
        "A folder that is not empty is refused. Exit status: 0 done; 2 the input is wrong, and nothing was written.",
    )
)
EXPORTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro export my-campaign/platform.yaml --out deck --calibration my-campaign-calibration",
        "jaxhydro export volturnus-s --out deck",
        "jaxhydro export volturnus-s --out raft --format raft",
        "jaxhydro export my-platform/platform.yaml --out lines --format moordyn",
        "[bold]What it writes[/bold]",
        "openfast: main.fst and the files that it names. raft: design.yaml. moordyn: lines.txt, of a platform with catenary "
        "lines. Beside them export.md: what was taken, approximated and left out. "
        "A folder that is not empty is refused. Exit status: 0 done; 2 the input is wrong, and nothing was written.",
    )
)
STATICS = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro statics volturnus-s",
        "jaxhydro statics my-platform/platform.yaml --offset surge=20 --offset sway=10",
        "jaxhydro statics my-platform/platform.yaml --force surge=1.5e6 --force pitch=1.5e8",
        "Forces act at the reference point, along the earth's axes: a thrust at a height also has a moment.",
    )
)
STARTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro init my-campaign",
        "jaxhydro init my-campaign decays/*.csv --scale 70",
        "jaxhydro init my-campaign roll.xlsx --platform my-platform.yaml",
        "[bold]What it writes[/bold]",
        "campaign.yaml, platform.yaml and copies of the data files (docs/formats.md). A folder that is not empty is refused. "
        "Exit status: 0 done; 2 the input is wrong, and nothing was written.",
    )
)
FITTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro calibrate my-campaign --out results",
        "jaxhydro calibrate my-campaign --tests waves --start results/calibration.json --out tuned",
        "jaxhydro calibrate my-campaign --tests waves --law choose --out laws",
        "jaxhydro calibrate my-campaign --tests all --out joint",
        "jaxhydro report results",
        "[bold]What it writes[/bold]",
        "calibration.json (docs/formats.md), simulated.nc, figures. Exit status: 0 done; 2 the input is wrong; 3 not "
        "converged or stopped, or a record is not followed; 130 stopped, nothing was written. With 3, what was reached is "
        "written and marked so.",
    )
)
DIAGNOSING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro diagnose my-campaign --out diagnosis",
        "jaxhydro report diagnosis",
        "jaxhydro simulate my-campaign --calibration diagnosis/diagnosis.json --out seas",
        "[bold]What makes a good campaign[/bold]",
        "Tests of one kind from small and large amplitudes: effects differ by how they grow. At least one test of every kind "
        "marked `use: holdout`: without one blocks of the fitted tests are left out in turn. Decays say nothing of "
        "what acts in "
        "waves only.",
        "[bold]What it writes[/bold]",
        "diagnosis.json (docs/formats.md), simulated.nc, figures. `jaxhydro report` makes one page of them to hand on. "
        "Exit status: 0 done; 2 the input is wrong; 3 not converged or stopped; 130 stopped, and the same command goes on. "
        "With 3, what was reached is written and marked so.",
    )
)
QUANTIFYING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro uncertainty my-campaign --calibration results/calibration.json --out uncertainty",
        "jaxhydro uncertainty my-campaign --calibration results --out uncertainty --profile column.Cd_t --bootstrap 200",
        "jaxhydro uncertainty my-campaign --calibration results --out uncertainty --profile '*' --nuts",
        "jaxhydro report uncertainty",
        "[bold]What it writes[/bold]",
        "uncertainty.json (docs/formats.md), figures. `jaxhydro report` makes one page of them to hand on. "
        "Exit status: 0 done; 2 the input is wrong; 3 not converged; 130 stopped, nothing was written. With 3, what was "
        "reached is written and marked so.",
    )
)
SWEEPING = "\n\n".join(
    (
        "[bold]A sweep file[/bold]",
        "platform: volturnus-s",
        "scatter: scatter.csv           # columns Hs,Tp,probability",
        "headings: [0, 30]              # deg",
        "seeds: 6",
        "All keys, and what it writes: docs/guide/sweeps.md.",
        "Exit status: 0 done; 2 the input is wrong; 3 runs failed, each with its reason in sweep.json; 130 stopped.",
    )
)
