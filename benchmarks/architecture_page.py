"""Keep the tree in docs/architecture.md that of the packages: every folder and file with the first line of its docstring.

python -m benchmarks.architecture_page
"""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "architecture.md"
BEGIN, END = "<!-- tree -->", "<!-- end of tree -->"
PACKAGES = ("jaxhydro", "calibration")
WIDTH = 30  # of names


def tree(folder: Path, depth: int = 0) -> Iterator[str]:
    """Yield the lines of a folder's tree: names, and what each is for."""
    yield _line(f"{folder.name}/", folder / "__init__.py", depth)
    entries = [path for path in folder.iterdir() if not path.name.startswith("_")]
    for entry in sorted(entries, key=lambda path: (path.is_dir(), path.name)):
        if entry.suffix == ".py":
            yield _line(entry.name, entry, depth + 1)
        elif entry.is_dir() and (entry / "__init__.py").exists():
            yield from tree(entry, depth + 1)


def _line(name: str, file: Path, depth: int) -> str:
    words = (ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or "").replace("\n", " ").split(". ")[0]
    return f"{'    ' * depth + name:<{WIDTH + 4}}  {words.rstrip('.')}"


def page(text: str) -> str:
    """Return the page with its tree renewed."""
    before, _, following = text.partition(BEGIN)
    after = following.partition(END)[2]
    trees = "\n\n".join("```text\n" + "\n".join(tree(ROOT / package)) + "\n```" for package in PACKAGES)
    return f"{before}{BEGIN}\n\n{trees}\n\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)} is written")
