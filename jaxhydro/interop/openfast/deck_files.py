"""Files of an OpenFAST deck, and the water that they state."""

from dataclasses import dataclass
from pathlib import Path

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.open_file import as_spelled, read_keyed_file

MOORDYN = 3  # CompMooring
NOT_FILES = ("", "none", "unused")
MODULES = {  # switch -> what is lost where it is on
    "CompInflow": "wind",
    "CompAero": "aerodynamic forces",
    "CompServo": "control",
    "CompIce": "ice",
    "CompSoil": "soil",
    "MHK": "a turbine under water",
}
OTHER_MOORINGS = {1: "MAP++", 2: "FEAMooring", 4: "OrcaFlex"}


@dataclass(frozen=True)
class WaterColumn:
    """Water of a deck.

    Attributes:
        density: kg/m3.
        depth: From still water to the bed, m.
        gravity: m/s2.
        level: Still water above mean sea level (MSL2SWL), from which the deck's heights count, m.
    """

    density: float
    depth: float
    gravity: float
    level: float


@dataclass(frozen=True)
class DeckFiles:
    """The files of a deck, as far as they describe the platform, its moorings and the sea.

    Attributes:
        main: The `.fst` file.
        elastodyn: ElastoDyn's file.
        hydrodyn: HydroDyn's file, or None where it is off.
        waves: SeaState's file, in older decks HydroDyn's, or None.
        moordyn: MoorDyn's file, or None.
    """

    main: KeyedFile
    elastodyn: KeyedFile
    hydrodyn: KeyedFile | None
    waves: KeyedFile | None
    moordyn: KeyedFile | None

    def all(self) -> list[KeyedFile]:
        """Every file once."""
        files = (self.main, self.elastodyn, self.hydrodyn, self.waves, self.moordyn)
        return list({file.path: file for file in files if file is not None}.values())


def beside(file: KeyedFile, key: str) -> Path:
    """Path of a file that another one names, relative to it."""
    return as_spelled(file.path.parent / file.word(key).replace("\\", "/"))


def open_deck(path: Path) -> DeckFiles:
    """Open the files of a deck.

    Args:
        path: The `.fst` file.

    Raises:
        InputError: One of them is missing, or the main file lacks a key.
    """
    main = read_keyed_file(path, "OpenFAST's main file, main.fst")
    elastodyn = read_keyed_file(beside(main, "EDFile"), "the file that EDFile names in the main file")
    hydrodyn = waves = moordyn = None
    if main.whole("CompHydro"):
        hydrodyn = read_keyed_file(beside(main, "HydroFile"), "the file that HydroFile names in the main file")
        waves = hydrodyn
    if main.whole("CompSeaSt", 0) and main.word("SeaStFile", "").lower() not in NOT_FILES:
        waves = read_keyed_file(beside(main, "SeaStFile"), "the file that SeaStFile names in the main file")
    if main.whole("CompMooring") == MOORDYN:
        moordyn = read_keyed_file(beside(main, "MooringFile"), "the file that MooringFile names in the main file")
    return DeckFiles(main, elastodyn, hydrodyn, waves, moordyn)


def water_of(deck: DeckFiles) -> WaterColumn:
    """Water of a deck: of the main file; in older decks of HydroDyn's, with ElastoDyn's gravity.

    A DEFAULT of SeaState and HydroDyn means the main file's value.

    Raises:
        InputError: A value is in none of them, or not positive.
    """

    def stated(key: str, standard: float | None = None) -> float:
        files = [file for file in (deck.waves, deck.hydrodyn, deck.main, deck.elastodyn) if file is not None]
        for file in files:
            if file.has(key) and file.word(key).lower() != "default":
                return file.number(key)
        if standard is not None:
            return standard
        raise InputError(str(deck.main.path), [Problem(key, f"a line with a value and {key}", "none in any file of the deck")])

    level = stated("MSL2SWL", 0.0)
    water = WaterColumn(stated("WtrDens"), stated("WtrDpth") + level, stated("Gravity"), level)
    for key, value in (("WtrDens", water.density), ("WtrDpth", water.depth), ("Gravity", water.gravity)):
        if value <= 0.0:
            raise InputError(str(deck.main.path), [Problem(key, "a number > 0", f"{value:g}")])
    return water


def module_items(main: KeyedFile) -> list[ConvertedItem]:
    """Items of the modules that the platform file has nothing for."""
    items = [
        ConvertedItem(f"{main.name}: {key}", Treatment.LEFT_OUT, f"The platform file has no {effect}.")
        for key, effect in MODULES.items()
        if main.has(key) and main.whole(key)
    ]
    if main.has("CompSub") and main.whole("CompSub"):
        meaning = "SubDyn's beams are left out, with their mass: the platform is rigid. Add their mass to `rigid_body`."
        items.append(ConvertedItem(f"{main.name}: CompSub", Treatment.LEFT_OUT, meaning))
    if (kind := main.whole("CompMooring")) in OTHER_MOORINGS:
        meaning = f"Moorings of {OTHER_MOORINGS[kind]} are not read. Give `mooring` by hand, or a MoorDyn file by --mooring."
        items.append(ConvertedItem(f"{main.name}: CompMooring", Treatment.LEFT_OUT, meaning))
    return items
