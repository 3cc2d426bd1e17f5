"""Decks of platforms in new folders, and platforms that are read back from decks."""

import shutil
from collections import Counter
from pathlib import Path

from ruamel.yaml import YAML

import jaxhydro as jh
from jaxhydro.cli.export_command import source_of
from jaxhydro.interop.converters import convert_file
from jaxhydro.interop.openfast.export_deck import export_deck


def written(platform: jh.Platform, folder: Path) -> dict[str, int]:
    """Write a platform's deck into a new folder.

    Args:
        platform: The platform.
        folder: The folder, which is made.

    Returns:
        Numbers of its items by what became of them.
    """
    exported = export_deck(source_of(platform, jh.build(platform)))
    folder.mkdir()
    for name, content in exported.texts.items():
        (folder / name).write_text(content, encoding="utf-8")
    for name, path in exported.files.items():
        shutil.copyfile(path, folder / name)
    return dict(Counter(item.treatment.value for item in exported.items))


def read_back(deck: Path, folder: Path) -> jh.Model:
    """Model of a deck, by way of its platform file.

    Args:
        deck: Main file of the deck.
        folder: Folder of platform.yaml and its tables, which is made.
    """
    conversion = convert_file(deck)
    folder.mkdir()
    for name, path in conversion.files.items():
        shutil.copyfile(path, folder / name)
    YAML().dump(conversion.platform, folder / "platform.yaml")
    return jh.build(jh.load_platform(folder / "platform.yaml"))
