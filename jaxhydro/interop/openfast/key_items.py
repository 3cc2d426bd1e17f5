"""What became of the keys of a file that a reader did not ask for, or asked for in vain."""

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.keyed_file import KeyedFile


def key_items(file: KeyedFile) -> list[ConvertedItem]:
    """Items on keys that a file lacks, and on keys that were not used.

    Args:
        file: The file, after everything was read.
    """
    items = []
    if file.absent:
        listed = ", ".join(f"{key} ({value or 'nothing'})" for key, value in file.absent.items())
        text = f"This version of the file has no such key. Taken instead: {listed}."
        items.append(ConvertedItem(f"{file.name}: keys of other versions", Treatment.APPROXIMATED, text))
    if unused := file.unused():
        text = f"Not used: {', '.join(unused)}."
        items.append(ConvertedItem(f"{file.name}: other keys", Treatment.LEFT_OUT, text))
    return items
