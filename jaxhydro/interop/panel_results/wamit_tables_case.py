"""Tables in WAMIT's formats (.1, .3, .12d, .hst, .out) of one body, by their root name."""

from pathlib import Path
from typing import Any

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.openfast.mass_parts import tidy
from jaxhydro.interop.panel_results.panel_case import PanelCase
from jaxhydro.interop.wamit_excitation import read_directional_excitation
from jaxhydro.interop.wamit_hydrostatics import read_hydrostatics
from jaxhydro.interop.wamit_radiation import read_wamit

ENDINGS = (".1", ".3", ".12d", ".hst")
OTHERS = {  # ending -> what it holds
    ".2": "wave forces by Haskind's relation",
    ".4": "motions in waves",
    ".7": "mean drift",
    ".8": "mean drift",
    ".9": "mean drift",
    ".12s": "forces at sum frequencies",
    ".6p": "pressures and elevations",
    ".5p": "pressures on the body",
    ".ss": "a state space of the radiation, which is fitted anew",
    ".ssexctn": "a state space of the wave forces",
}


def with_ending(folder: Path, ending: str, root: str | None = None) -> Path | None:
    """The file of a folder with an ending, in upper or lower case, and with a root name where one is given.

    Raises:
        InputError: There are several.
    """
    names = [
        path
        for path in sorted(folder.iterdir())
        if path.is_file() and path.suffix.lower() == ending and root in (None, path.stem)
    ]
    if len(names) > 1:
        listed = ", ".join(path.name for path in names)
        hint = f"Name one of them: jaxhydro convert {names[0]}"
        raise InputError(str(folder), [Problem("", f"one file that ends in {ending}", listed, hint)])
    return names[0] if names else None


def add_tables(case: PanelCase, folder: Path, root: str | None, length: float, by: str, weight_at: float | None = None) -> None:
    """Add the tables of a folder to a case, which has its water.

    Args:
        case: The case.
        folder: Folder of the tables.
        root: Their name without ending; None: each ending once.
        length: Unit of length L of the files (m).
        by: What their first column is: "period", "rad/s" or "Hz".
        weight_at: Height (m) of the centre of mass whose weight C44 and C55 of the .hst file include, with the case's volume;
            None: not stated.

    Raises:
        InputError: A table is broken, there are several, or there is neither radiation nor excitation.
    """
    tables = {ending: path for ending in ENDINGS if (path := with_ending(folder, ending, root))}
    if not {".1", ".3"} & set(tables):
        expected = "WAMIT's tables of radiation (.1) or wave forces (.3)"
        raise InputError(str(folder), [Problem("", expected, f"neither{f' of {root}' if root else ''}")])
    case.name = case.name or next(path.stem for path in tables.values())
    density, gravity = case.water()
    options: dict[str, Any] = ({"length": length} if length != 1.0 else {}) | ({"by": by} if by != "period" else {})

    def entry(path: Path, **more: Any) -> dict[str, Any]:
        case.files[path.name] = path
        return {"file": path.name} | {key: value for key, value in options.items() if key not in more.get("without", ())}

    if path := tables.get(".1"):
        case.coefficients = read_wamit(path, density, length, by)
        case.keys["radiation"] = entry(path)
        case.say(
            path.name, Treatment.TAKEN, f"`radiation`: added mass and damping at {len(case.coefficients.omega)} frequencies."
        )
    if path := tables.get(".3"):
        table = read_directional_excitation(path, density, gravity, length=length, by=by)
        knots = table.by_heading.heading
        case.force = table.towards(float(knots[0]))
        case.keys["excitation"] = entry(path)
        case.say(path.name, Treatment.TAKEN, f"`excitation`: first-order wave forces; headings: {knots.size}.")
    if path := tables.get(".12d"):
        case.keys["drift"] = entry(path)
        case.say(path.name, Treatment.TAKEN, "`drift`: forces at difference frequencies, all pairs of frequencies.")
    if (path := tables.get(".hst")) and "hydrostatics" not in case.keys:
        statics = read_hydrostatics(path, density, gravity, length=length)
        case.keys["hydrostatics"] = entry(path, without=("by",)) | {"linear": True}
        if weight_at is None or case.volume is None:
            case.keys["hydrostatics"] |= {"weight": "included"}
            text = (
                "`hydrostatics`: C33, C44, C55 and their couplings. C44 and C55 are taken to include the weight, as WAMIT's do."
            )
            case.say(path.name, Treatment.TAKEN, text)
            hint = "The file does not say which weight C44 and C55 include. Of files made for OpenFAST: `weight: excluded`."
            case.say("hydrostatics.weight", Treatment.TO_FILL_IN, hint)
        else:
            moment = density * gravity * case.volume * weight_at  # of the displaced water's weight, as WAMIT has it
            buoyancy = {f"{key}_buoyancy": tidy(float(statics.stiffness[i, i]) + moment) for key, i in (("C44", 3), ("C55", 4))}
            case.keys["hydrostatics"] |= {"displaced_volume": case.volume} | buoyancy
            text = f"C44 and C55 include the weight at z = {weight_at:g} m: it is replaced by that of `rigid_body`."
            case.say(path.name, Treatment.TAKEN, f"`hydrostatics`: C33, C44, C55 and their couplings. {text}")
    for path in sorted(folder.iterdir()):
        if (what := OTHERS.get(path.suffix.lower())) and root in (None, path.stem):
            case.say(path.name, Treatment.LEFT_OUT, f"There is no key for {what}.")
