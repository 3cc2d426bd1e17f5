"""Words that options of the command line take."""

from enum import StrEnum


class DeckFormat(StrEnum):
    """Program that a model is written for."""

    openfast = "openfast"
    raft = "raft"
    moordyn = "moordyn"


class MotionFormat(StrEnum):
    """Further file of a simulated motion."""

    netcdf = "netcdf"
    outb = "outb"


class Spectrum(StrEnum):
    """Spectra by name."""

    jonswap = "jonswap"
    pierson_moskowitz = "pierson-moskowitz"
    white = "white"


class Amplitudes(StrEnum):
    """See `spectrum_components`."""

    deterministic = "deterministic"
    rayleigh = "rayleigh"


class Fitted(StrEnum):
    """Which tests are fitted."""

    decays = "decays"
    waves = "waves"
    all = "all"


class Objective(StrEnum):
    """See `calibration.calibrate_in_waves`."""

    bands = "bands"
    spectrum = "spectrum"
    motion = "motion"
    both = "both"
    blocks = "blocks"


class Loss(StrEnum):
    """See `calibration.calibrate_jointly`."""

    squares = "squares"
    cauchy = "cauchy"


class Law(StrEnum):
    """How coefficients depend on the sea state: see `calibration.choose_law`."""

    constant = "constant"
    significant_height = "significant-height"
    peak_period = "peak-period"
    both = "both"
    keulegan_carpenter = "keulegan-carpenter"
    high_pass = "high-pass"
    choose = "choose"


class Diffraction(StrEnum):
    """See `Model`."""

    maccamy_fuchs = "maccamy_fuchs"
    ramp = "ramp"
    none = "none"


class Stretch(StrEnum):
    """See `WaveSea`."""

    none = "none"
    vertical = "vertical"
    wheeler = "wheeler"
    extrapolation = "extrapolation"
