"""Pages of the documentation site that are no files of docs/, and what is changed in the others as they are read.

Notebooks, CONTRIBUTING.md and CHANGELOG.md are copied. The references of commands and Python names are made. Git ignores them.
The Markdown of docs/ stays as it is: it is read on GitHub, too.
"""

import inspect
import posixpath
import re
from collections.abc import Iterable, Iterator
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from typer.models import ArgumentInfo

REPOSITORY = "https://github.com/jaxhydro/jaxhydro"
ROOT = Path(__file__).resolve().parents[1]

TOCTREES = {  # of the page before the colon; they are appended to it, so that nothing of them is seen on GitHub
    "index": (
        *("quickstart", "tutorials/index", "guide/index", "reference/index"),
        *("Validation <verified>", "FAQ <faq>", "project"),
    ),
    "guide/index": (
        *("calibrate", "waves", "diagnose", "diagnose-results", "sweeps"),
        *("uncertainty", "python", "convert", "own-effect", "../formats"),
    ),
    "reference/index": (
        *("../theory", "../conventions", "../comparison", "../constants"),
        *("commands", "python/index", "../glossary"),
    ),
    "verified": ("validation", "speed", "discovery-benchmark"),
    "project": ("contributing", "architecture", "changelog"),
}
SITE_LINKS = {  # in the page of the key; to pages that only the site has
    "reference/index": {"all commands": "commands.md", "all public names of Python": "python/index.rst"},
    "index": {"all commands": "reference/commands.md", "all Python names": "reference/python/index.rst"},
}
ROOT_PAGES = {"contributing": "CONTRIBUTING.md", "changelog": "CHANGELOG.md"}
MODULES = (  # in the reference of Python names; a name is described in the first that has it
    "jaxhydro",
    "calibration",
    "jaxhydro.waves",
    "jaxhydro.analysis",
    "jaxhydro.sweep",
    "jaxhydro.loads",
    "jaxhydro.loads.drag",
    "jaxhydro.water",
    "jaxhydro.sensors",
    "jaxhydro.units",
    "jaxhydro.jax_settings",
)


def make_pages(docs: Path) -> None:
    """Copy and make what is no file of the folder.

    Args:
        docs: The folder of the documentation.
    """
    notebooks = sorted((ROOT / "notebooks").glob("*.ipynb"))
    pages = {f"tutorials/{path.name}": path.read_text(encoding="utf-8") for path in notebooks}
    pages |= {f"{page}.md": (ROOT / name).read_text(encoding="utf-8") for page, name in ROOT_PAGES.items()}
    pages["reference/commands.md"] = "\n".join(command_pages())
    pages |= {f"reference/python/{name}.rst": text for name, text in module_pages()}
    for name, text in pages.items():
        file = docs / name
        file.parent.mkdir(exist_ok=True)
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")
    for folder, ending in (("tutorials", "ipynb"), ("reference/python", "rst")):  # of an earlier build
        for file in (docs / folder).glob(f"*.{ending}"):
            if f"{folder}/{file.name}" not in pages:
                file.unlink()


# --- what is changed as a page is read


def as_site_page(app: Any, docname: str, source: list[str]) -> None:
    """Point links at pages of the site or at the repository, and add the page's table of contents.

    Args:
        app: Sphinx.
        docname: Page, without its ending.
        source: The page's text, changed in place.
    """
    if docname.startswith("reference/python/"):
        return
    origin = ROOT_PAGES.get(docname, f"docs/{docname}")
    origin = re.sub("^docs/tutorials/(?=\\d)", "notebooks/", origin)
    folder, page_folder = posixpath.dirname(origin), posixpath.dirname(docname)
    text = re.sub(r"(?<=\]\()(?![a-z]+:|#)([^)\s]+)(?=\))", lambda link: _link(link[1], folder, page_folder), source[0])
    text = re.sub(r"\$`([^`]+)`\$", r"$\1$", text)  # GitHub's second way to write formulas
    text = re.sub(r"\[[\w/-]+\.md\](?=\()", "[]", text)  # a page or section by its title, not by its file
    for words, page in SITE_LINKS.get(docname, {}).items():
        text = text.replace(words, f"[{words}]({page})")
    pages = TOCTREES.get(docname, ())
    if docname == "tutorials/index":
        pages = tuple(path.stem for path in sorted((ROOT / "notebooks").glob("*.ipynb")))
    if pages:
        text += "\n".join(("", "", "```{toctree}", ":hidden:", "", *pages, "```", ""))
    source[0] = text


def _link(link: str, folder: str, page_folder: str) -> str:
    """The link of a file of the repository, as it is in a page of the site; broken links stay, and Sphinx names them."""
    path, _, anchor = link.partition("#")
    target = posixpath.normpath(posixpath.join(folder, path))
    places = {name: f"{page}.md" for page, name in ROOT_PAGES.items()} | {
        "README.md": "index.md",
        "notebooks": "tutorials/index.md",
    }
    if target in places:
        page = places[target]
    elif target.startswith("notebooks/"):
        page = f"tutorials/{posixpath.basename(target)}"
    elif re.match(r"docs/(?!evidence).*\.(md|png)$", target):
        page = target.removeprefix("docs/")
    elif (ROOT / target).exists():
        return f"{REPOSITORY}/{'tree' if (ROOT / target).is_dir() else 'blob'}/main/{target}" + (anchor and f"#{anchor}")
    else:
        return link
    return posixpath.relpath(page, page_folder or ".") + (anchor and f"#{anchor}")


def as_restructured_text(app: Any, what: str, name: str, of: Any, options: Any, lines: list[str]) -> None:
    """Escape what plain text and reStructuredText read differently: |u|, a * b, names_ that end so."""
    escaped = []
    for line in lines:
        parts = re.split(r"(`[^`]*`)", line)
        parts[::2] = [re.sub(r"\\|\*|\||(?<=\w)_(?!\w)", r"\\\g<0>", part) for part in parts[::2]]
        escaped.append("".join(parts))
    lines[:] = escaped


# --- commands


def command_pages() -> Iterator[str]:
    """Yield the lines of the reference of commands, made of the program's own help."""
    from jaxhydro.cli.app import app

    yield from ("# Commands", "", "The same text is printed by `jaxhydro --help` and `jaxhydro COMMAND --help`.", "")
    yield from (*_prose(app.info.help), "", "| command | what it does |", "|---|---|")
    for command in app.registered_commands:
        name, text = _name_and_help(command)
        first = text.split("\n\n")[0]
        yield f"| [`{name}`](#jaxhydro-{name}) | {_cell(first)} |"
    yield from ("", *_epilog(app.info.epilog))
    for command in app.registered_commands:
        name, text = _name_and_help(command)
        parameters = list(_parameters(command.callback))
        usage = " ".join((name, *(each["usage"] for each in parameters if each["usage"])))
        yield from (f"## jaxhydro {name}", "", *_prose(text), "", "```console", f"$ jaxhydro {usage} [OPTIONS]", "```", "")
        for heading in dict.fromkeys(each["heading"] for each in parameters):
            yield from (f"**{heading}**", "", "| name | value | meaning | default |", "|---|---|---|---|")
            yield from (each["row"] for each in parameters if each["heading"] == heading)
            yield ""
        yield from _epilog(command.epilog)


def _name_and_help(command: Any) -> tuple[str, str]:
    return command.name or command.callback.__name__.replace("_", "-"), inspect.getdoc(command.callback) or ""


def _parameters(command: Any) -> Iterator[dict[str, str]]:
    """Yield heading, row of the table, and word in the usage line of every parameter of a command."""
    hints = get_type_hints(command, include_extras=True)
    for name, parameter in inspect.signature(command).parameters.items():
        if get_origin(hints[name]) is not Annotated:
            continue  # typer's own context
        kind, info = get_args(hints[name])[:2]
        argument, required = isinstance(info, ArgumentInfo), parameter.default is parameter.empty
        word = (info.metavar or name.upper()) if argument else ", ".join(info.param_decls or _switch(name, kind))
        usage = word + " ..." * ("list" in str(kind)) if argument else f"{word} {name.upper()}"
        default = "*required*" if required else _default(info.show_default, parameter.default)
        yield {
            "heading": info.rich_help_panel or ("Arguments" if argument else "Options"),
            "row": f"| {_code(word)} | {'' if argument else _value(kind, info)} | {_cell(info.help or '')} | {default} |",
            "usage": usage if required else f"[{usage}]" if argument else "",
        }


def _switch(name: str, kind: Any) -> tuple[str, ...]:
    option = name.replace("_", "-")
    return (f"--{option}", f"--no-{option}") if kind is bool else (f"--{option}",)


def _value(kind: Any, info: Any) -> str:
    """Kind of value that an option takes; empty for a switch."""
    if info.metavar:
        return _code(info.metavar)
    (kind, *_), many = [each for each in (get_args(kind) or (kind,)) if each is not type(None)], "list" in str(kind)
    kind = get_args(kind)[0] if many and get_args(kind) else kind
    if isinstance(kind, type) and issubclass(kind, Enum):
        return ", ".join(_code(each.value) for each in kind)
    words = {bool: "", str: "text", int: "whole number", float: "number", Path: "path"}
    return words[kind] + ", repeatable" * many


def _default(shown: Any, value: Any) -> str:
    if isinstance(shown, str):
        return _cell(shown)
    if isinstance(value, bool):
        return "on" if value else "off"
    return "" if value is None else _code(getattr(value, "value", value))


def _code(word: Any) -> str:
    return f"`{word}`"


def _prose(text: str | None) -> list[str]:
    """Lines of a help text as Markdown; files of docs/ are links."""
    plain = re.sub(r"(?<!`)--[a-z][\w-]*", r"`\g<0>`", text or "")
    return re.sub(r"docs/([\w/-]+)\.md", r"[\1](../\1.md)", plain).replace("<", "&lt;").splitlines()


def _cell(text: str) -> str:
    return " ".join(_prose(text)).replace("|", "\\|")


def _epilog(text: str | None) -> Iterator[str]:
    """Yield what stands below the options: headings, commands and prose."""
    code: list[str] = []
    for part in (*(text or "").split("\n\n"), ""):
        if re.match(r"jaxhydro |\w+: .*#|platform: |scatter: |seeds: ", part):
            code.append(part)
            continue
        if code:
            yield from ("```console" if code[0].startswith("jaxhydro") else "```yaml", *code, "```", "")
            code = []
        if part:
            yield from (*_prose(re.sub(r"\[/?bold\]", "**", part)), "")


# --- Python names


def module_pages() -> Iterator[tuple[str, str]]:
    """Yield names and texts of the pages of the reference of Python names."""
    described: dict[int, str] = {}
    names: dict[str, list[str]] = {}
    for module in MODULES:
        names[module] = [name for name in _public(module) if id(getattr(import_module(module), name)) not in described]
        described |= {id(getattr(import_module(module), name)): f"{module}.{name}" for name in names[module]}
    for module in MODULES:
        yield module, "\n".join(_module_page(module, names[module], described))
    index = [
        "Python",
        "======",
        "",
        "Angles are in radians, all other units are SI. :doc:`The guide </guide/python>` has examples.",
        "",
    ]
    index += ["The tables below list every public name, with the first sentence of its description.", ""]
    yield "index", "\n".join((*index, ".. toctree::", "   :maxdepth: 1", "", *(f"   {module}" for module in MODULES), ""))


def _public(module: str) -> list[str]:
    loaded = import_module(module)
    own = [name for name, value in vars(loaded).items() if getattr(value, "__module__", None) == module and name[0] != "_"]
    return list(getattr(loaded, "__all__", own))


def _module_page(module: str, names: Iterable[str], described: dict[int, str]) -> Iterator[str]:
    loaded = import_module(module)
    kinds: dict[str, list[str]] = {"Functions": [], "Classes": [], "Data": []}
    for name in sorted(names, key=str.lower):
        value = getattr(loaded, name)
        kinds["Classes" if isinstance(value, type) else "Functions" if callable(value) else "Data"].append(name)
    yield from (module, "=" * len(module), "", f".. automodule:: {module}", "   :no-members:", "")
    yield from (f".. currentmodule:: {module}", "")
    for kind, members in kinds.items():
        if members and kind != "Data":
            yield from (
                ".. rubric:: " + kind,
                "",
                ".. autosummary::",
                "   :nosignatures:",
                "",
                *(f"   {name}" for name in members),
                "",
            )
    for kind, members in kinds.items():
        if members:
            yield from (kind, "-" * len(kind), "")
        for name in members:
            if kind == "Functions":
                yield from (f".. autofunction:: {name}", "")
            elif kind == "Classes":
                yield from (f".. autoclass:: {name}", "   :members:", "   :show-inheritance:", "")
            else:
                yield from _data(module, name, getattr(loaded, name), described)


def _data(module: str, name: str, value: Any, described: dict[int, str]) -> Iterator[str]:
    """Yield the description of a constant or of a registry, which lists its classes."""
    yield from (f".. py:data:: {name}", "")
    if isinstance(value, dict):
        for key, entry in value.items():
            target = described.get(id(entry), f"{entry.__module__}.{entry.__name__}")
            yield f"   - ``{key}``: :py:obj:`{target.rsplit('.', 1)[1]} <{target}>`"
    else:
        yield f"   ``{value!r}``"
    yield ""
