"""A latent force and its law in words."""

from calibration.discovery.latent_force.term_library import LAG_RATIOS, LAGGED_TERMS
from calibration.discovery.reported_forces import LatentForce, Law, LawTerm
from calibration.formatting import listed, number, percent, quantity, readable_unit

MIN_COHERENCE = 0.5  # fraction of the force, to be mentioned
MOTIONS = ("velocity", "position", "acceleration")  # that a force is compared with
BAND_WORDS = {
    "mean": "in the mean",
    "slower": "slower than the motion",
    "own": "at the motion's own frequency",
    "low_frequency": "slower than the waves",
    "wave_frequency": "at the waves' frequencies",
    "higher": "at higher frequencies",
}
WAVE_WORDS = {"elevation": "the wave elevation", "squared_envelope": "the squared wave envelope"}


def sentence(latent: LatentForce) -> str:
    """A latent force in a sentence."""
    phrases, where = [], {"decay": "in decays", "waves": "in waves"}
    for name, rms in latent.rms.items():
        band, share = max(latent.shares[name].items(), key=lambda item: item[1])
        phrases.append(
            f"{quantity(rms, None, latent.unit)} rms {where[name]}, {percent(share)} of its square {BAND_WORDS[band]}"
        )
    with_what = []
    for name, rows in latent.coherence.items():
        motion = max((k for k in MOTIONS if k in rows), key=lambda k: round(abs(rows[k].correlation), 1), default=None)
        named = [k for k in WAVE_WORDS if k in rows and rows[k].coherence > MIN_COHERENCE]
        if motion is not None and abs(rows[motion].correlation) > MIN_COHERENCE:
            against = "against" if rows[motion].correlation < 0 else "with"
            with_what.append(f"{where[name]} mostly {against} the {motion} (correlation {number(rows[motion].correlation, 2)})")
        with_what += [f"coherent with {WAVE_WORDS[k]} ({number(rows[k].coherence, 2)})" for k in named]
    main = max(latent.shares["waves"].items(), key=lambda row: row[1])[0] if "waves" in latent.shares else ""
    told = {name: p for name, p in latent.growth.items() if name in ("amplitude", f"significant_height.{main}")}
    grows = [f"it grows as the power {number(p, 2)} of the {_size(name)}" for name, p in told.items()]
    parts = [
        f"{latent.motion.capitalize()}: the model lacks a {'moment' if latent.unit == 'N m' else 'force'} of {listed(phrases)}"
    ]
    parts += [", ".join(with_what)] if with_what else []
    return "; ".join([*parts, *grows, law_in_words(latent.law, latent.unit)]) + "."


def _size(name: str) -> str:
    height, _, band = name.partition(".")
    return f"significant wave height {BAND_WORDS[band]}" if height == "significant_height" else "motion's amplitude"


def law_in_words(law: Law, unit: str) -> str:
    """A force law and the share that it explains, in words."""
    if not law.terms:
        return f"no law of up to three terms explains it (the best {percent(law.share)} of it in {law.checked or 'the tests'})"
    sizes = [(term, f"{number(term.coefficient, 3)} {readable_unit(term.unit)}") for term in law.terms]
    parts = [f"({size}) {_term(term, law)}".removesuffix(" 1") for term, size in sizes]
    text, speed = " + ".join(parts), "rad/s" if unit == "N m" else "m/s"
    v0 = f", v0 = {number(law.v0, 2)} {speed}" if any("v0" in term.name for term in law.terms) else ""
    return f"{text} explains {percent(law.share)} of it in {law.checked}{v0}"


def _term(term: LawTerm, law: Law) -> str:
    """Name of a term; for lagged velocity with its time constant."""
    if term.kind not in LAGGED_TERMS:
        return term.name
    return f"v lagged by a time constant of {number(LAG_RATIOS[term.kind - LAGGED_TERMS.start] / law.pace, 2)} s"
