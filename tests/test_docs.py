"""What the pages say is true: files and names exist, links lead somewhere, code runs, and the site builds without a warning."""

import importlib
import re
import shlex
import subprocess
import sys
import tomllib
from functools import cache, reduce
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [*ROOT.glob("*.md"), *sorted((ROOT / "docs").rglob("*.md"))]
MODULES = [path for wing in ("controllers", "game") for path in sorted((ROOT / wing).rglob("*.py"))]
LINK = re.compile(r"\[[^]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)
QUOTED = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")
FILE = re.compile(r"[\w./-]+\.(?:py|md|toml|ipynb|npz|webp|png|cff)|(?:controllers|game|assets|scripts|examples|tests|docs)(?:/[\w.-]+)*/?")
NAME = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+")
USERS = {"my.toml", "mine.toml", "mine.npz", "far.png", "mine.png", "NAME.png", "truth.npz", "library.npz", "jumps.npz",
         "network.npz", "database.gambolmotion"}
"""Files that a reader makes."""


def by_name(page):
    return str(page.relative_to(ROOT))


def prose(page):
    """A page without its blocks of code."""
    return FENCE.sub("", page.read_text("utf-8"))


@cache
def files():
    """All files and folders of the project, as paths within it."""
    listed = [path for folder in ("gambol", "controllers", "game", "assets", "scripts", "examples", "tests", "docs")
              for path in (ROOT / folder).rglob("*") if "__pycache__" not in path.parts] + list(ROOT.glob("*"))
    return {path.relative_to(ROOT).as_posix() for path in listed}


@cache
def modules():
    """Every module of ours by the last part of its name."""
    found = {}
    for path in MODULES:
        parts = path.relative_to(ROOT).with_suffix("").parts
        parts = parts[:-1] if parts[-1] == "__init__" else parts
        if parts[-1] != "__main__":
            found.setdefault(parts[-1], []).append(".".join(("gambol", *parts)))
    return found


def there_is(name):
    """Whether a dotted name means something: a module, or a public name in a module, as far as it goes."""
    first, *rest = parts = name.split(".")
    if first == "gambol":
        long = next(k for k in range(len(parts), 1, -1) if any(".".join(parts[:k]) in places for places in modules().values())
                    or parts[:k] in (["gambol", "controllers"], ["gambol", "game"], ["gambol", "assets"]))
        return has(importlib.import_module(".".join(parts[:long])), parts[long:])
    owners = [importlib.import_module(place) for place in modules().get(first, ())]
    owners += [vars(importlib.import_module(place))[first] for places in modules().values() for place in places
               if first[:1].isupper() and first in vars(importlib.import_module(place))]
    return any(has(owner, rest) for owner in owners)


def has(owner, names):
    def inner(thing, name):
        fields = getattr(thing, "__dataclass_fields__", {})
        return True if name in fields else getattr(thing, name)
    try:
        reduce(inner, names, owner)
    except AttributeError:
        return False
    return True


@pytest.mark.parametrize("page", PAGES, ids=by_name)
def test_files_that_a_page_names_are_there(page):
    """In full from the project's folder, or their end where a page is about one room."""
    for word in QUOTED.findall(prose(page)):
        word = word.split(" ")[0] if word.startswith(("scripts/", "examples/")) else word.removeprefix(".")
        if FILE.fullmatch(word) and word not in USERS:
            assert any(file == word.rstrip("/") or file.endswith("/" + word.rstrip("/")) for file in files()), word


@pytest.mark.parametrize("page", PAGES, ids=by_name)
def test_names_that_a_page_names_are_there(page):
    for word in QUOTED.findall(prose(page)):
        first = word.split(".")[0]
        if NAME.fullmatch(word) and not FILE.fullmatch(word) and word not in USERS and (first == "gambol" or first in modules() or first[0].isupper()):
            assert there_is(word), word


def test_names_of_the_glossary_are_where_it_says():
    """Each plain name in the middle column is defined in one of the files at the end of its row, or handed out by one."""
    checked = 0
    for row in (ROOT / "docs" / "glossary.md").read_text("utf-8").splitlines():
        cells = row.strip("|").split("|")
        if len(cells) != 3 or ".py" not in cells[2]:
            continue
        places = [importlib.import_module("gambol." + word.removesuffix(".py").replace("/", ".").removesuffix(".__init__"))
                  for word in QUOTED.findall(cells[2]) if word.startswith(("controllers", "game"))]
        for word in QUOTED.findall(cells[1]):
            if re.fullmatch(r"[A-Za-z_]\w+", word) and places:
                siblings = [importlib.import_module(place.__name__.rpartition(".")[0]) for place in places]
                assert any(hasattr(place, word) for place in places + siblings), f"{word} is not in {cells[2]}"
                checked += 1
    assert checked > 30


def test_the_house_names_every_room():
    told = set(QUOTED.findall((ROOT / "docs" / "house.md").read_text("utf-8")))
    rooms = {path.parent.relative_to(ROOT).as_posix() for path in MODULES if path.name == "__init__.py"} - {"controllers", "game"}
    single = {path.relative_to(ROOT).as_posix() for path in MODULES if len(path.relative_to(ROOT).parts) == 2} - {
        "controllers/__init__.py", "game/__init__.py"}
    assert rooms | single <= told


@pytest.mark.parametrize("page", [page for page in PAGES if page.parent == ROOT], ids=by_name)
def test_links_of_pages_outside_the_site_lead_somewhere(page):
    """Those within it may lead to rooms."""
    for link in LINK.findall(prose(page)):
        if not link.startswith(("http", "#")):
            assert (page.parent / link.split("#")[0]).exists(), link


@pytest.mark.parametrize("page", [page for page in PAGES if re.search(r"^```python\n(?!--8<--)", page.read_text("utf-8"), re.M)], ids=by_name)
def test_code_of_a_page_runs(page, capsys):
    """All blocks of a page, one after the other, as a reader would try them."""
    names = {}
    for kind, code in FENCE.findall(page.read_text("utf-8")):
        if kind == "python" and not code.startswith("--8<--"):
            exec(compile(code, by_name(page), "exec"), names)
    assert "state" in names or "thrown" in names


def test_there_is_code_that_runs():
    assert {"README.md", "import.md"} <= {page.name for page in PAGES if "```python\nimport" in page.read_text("utf-8")}


@pytest.mark.parametrize("page", [page for page in PAGES if "```toml" in page.read_text("utf-8")], ids=by_name)
def test_toml_of_a_page_is_what_gambol_reads(page, tmp_path):
    from gambol.controllers.reconstruction.live import read_map
    from gambol.controllers.tracking.cameras import read_cameras
    from gambol.game.scenario import load

    for kind, text in FENCE.findall(page.read_text("utf-8")):
        if kind == "toml":
            file = tmp_path / "x.toml"
            file.write_text(text, "utf-8")
            tables = tomllib.loads(text)
            cameras = any("size" in table for table in tables.values() if isinstance(table, dict))
            (load if "actors" in tables else read_cameras if cameras else read_map)(file)


def commands():
    """Every `gambol …` that a page shows."""
    for page in PAGES:
        for line in page.read_text("utf-8").splitlines():
            if line.startswith("    gambol "):
                yield by_name(page), line.split(" #")[0].strip()


@cache
def program():
    from typer.main import get_command

    from gambol.game.cli import app

    return get_command(app)


@pytest.mark.parametrize("line", sorted(set(commands())), ids=lambda one: one[1])
def test_commands_of_a_page_are_commands(line):
    """With options that they have."""
    command, words = program(), shlex.split(line[1])[1:]
    while hasattr(command, "commands"):
        command = command.commands[words.pop(0)]
    known = {name for option in command.params for name in (*option.opts, *option.secondary_opts)}
    assert {word for word in words if word.startswith("-")} <= known


SITE = sorted((ROOT / "docs").rglob("*.md"))


def anchors(page):
    """Those of a page's headings, as MkDocs makes them; of what it takes in, too."""
    toc = pytest.importorskip("markdown.extensions.toc", reason="MkDocs is not installed: pip install -e '.[test]'")
    text = FENCE.sub(lambda block: (ROOT / taken[1]).read_text("utf-8") if (taken := re.search(r'--8<-- "([^"]+)"', block[0])) else "", page.read_text("utf-8"))
    text = re.sub(r'^--8<-- "([^"]+)"', lambda taken: (ROOT / taken[1]).read_text("utf-8"), text, flags=re.M)
    return {toc.slugify(re.sub(r"[`*]", "", heading), "-") for heading in re.findall(r"^#+ (.+)$", text, re.M)}


@pytest.mark.parametrize("page", SITE, ids=by_name)
def test_links_of_pages_within_the_site_lead_somewhere(page):
    """To a page, or the page that is made of a room's docstrings, and to a heading on it."""
    for link in LINK.findall(prose(page)):
        if not link.startswith("http"):
            path, _, anchor = link.partition("#")
            there = (page.parent / path).resolve() if path else page
            if there.parent == ROOT / "docs" / "api":
                assert there.stem == "index" or there_is(f"gambol.{there.stem}"), link
            else:
                assert there.exists() and (not anchor or there.suffix != ".md" or anchor in anchors(there)), link


def test_every_page_is_in_the_menu():
    yaml = pytest.importorskip("yaml", reason="MkDocs is not installed: pip install -e '.[test]'")

    def pages(menu):
        for item in menu:
            yield from [item] if isinstance(item, str) else (page for part in item.values() for page in ([part] if isinstance(part, str) else pages(part)))
    assert sorted(pages(yaml.safe_load((ROOT / "mkdocs.yml").read_text("utf-8"))["nav"])) == sorted(page.relative_to(ROOT / "docs").as_posix() for page in SITE)


@pytest.mark.thorough
def test_the_site_builds_without_a_warning(tmp_path):
    """Every link and anchor is followed, those of docstrings, too: ten to twenty seconds."""
    pytest.importorskip("mkdocs", reason="MkDocs is not installed: pip install -e '.[test]'")
    pytest.importorskip("mkdocstrings_handlers.python", reason="mkdocstrings is not installed: pip install -e '.[test]'")
    done = subprocess.run([sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")],
                          cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    contract = (tmp_path / "site" / "api" / "controllers.contract.html").read_text("utf-8")
    assert "gambol.controllers.contract.Controller.precondition" in contract and "How well it could start from here" in contract
    body = (tmp_path / "site" / "api" / "controllers.body.html").read_text("utf-8")
    assert "forward_kinematics" in body and "World positions" in body, "what a door hands out is on its page"
    outside = [link for file in (tmp_path / "site").rglob("*.html")
               for link in re.findall(r"<(?:script|img|link)[^>]*(?:src|href)=\"(https?:[^\"]+)", file.read_text("utf-8"))]
    assert not outside, "nothing is fetched from elsewhere"


def test_the_citation_can_be_read():
    """With what CFF 1.2 asks for, of us and of every paper."""
    yaml = pytest.importorskip("yaml", reason="PyYAML, which comes with MkDocs, is not installed: pip install -e '.[test]'")
    told = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert told["cff-version"] == "1.2.0" and told["message"] and told["license"] == "MIT"
    for work in (told, *told["references"]):
        assert work["type"] and work["title"] and all("name" in who or "family-names" in who for who in work["authors"])
    papers = {work["authors"][0]["family-names"] for work in told["references"]}
    assert papers == {"Truong", "Ooi", "Mousas", "Rosenhahn"}


def test_the_command_says_its_version():
    from importlib.metadata import version

    done = subprocess.run([sys.executable, "-m", "gambol.game.cli", "--version"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout == f"gambol {version('gambol')}\n"


def test_changes_are_told():
    """What is unreleased comes first, then versions from the newest on."""
    told = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.M)
    versions = [tuple(map(int, one.split(" ")[0].split("."))) for one in told if one != "Unreleased"]
    assert told[0] == "Unreleased" and versions and versions == sorted(versions, reverse=True)


def test_the_page_of_a_scenarios_fields_is_what_the_program_prints():
    """Made anew by `gambol scenarios --fields > docs/fields.md`; and every field is told of in words."""
    from gambol.game.scenario.described import described, told
    from gambol.game.scenario.scenario import Scenario, tables_of

    assert (ROOT / "docs" / "fields.md").read_text("utf-8") == described() + "\n"
    tables, seen = [Scenario], set()
    while tables:
        table = tables.pop()
        seen.add(table)
        for own, field in table.model_fields.items():
            assert re.search(rf"\b{field.alias or own}\b", told(table)), f"{table.__name__}.{own}"
            tables += [one for one in tables_of(field.annotation) if one not in seen]
    assert len(seen) > 12


def test_the_page_of_commands_is_what_they_tell():
    """Made anew by `scripts/build/pages/commands_page.py > docs/commands.md`."""
    done = subprocess.run([sys.executable, ROOT / "scripts" / "build" / "pages" / "commands_page.py"], capture_output=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert (ROOT / "docs" / "commands.md").read_text("utf-8") == done.stdout.decode("utf-8").replace("\r\n", "\n")
