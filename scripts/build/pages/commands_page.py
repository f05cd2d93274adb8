"""Every command with its options as a page, `docs/commands.md`, from what the commands themselves tell:

    .venv/bin/python scripts/build/pages/commands_page.py > docs/commands.md
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from typing import Any

import typer

HEAD = """# All commands

What `gambol COMMAND --help` says, of all commands; `-h` is `--help`. [What they are for](index.md).

What is told besides results goes to the standard error. A command ends with 0 when all went well, with 2 for a mistake in what
was given, told in a line that names it, with 3 where a window cannot be opened, and with 130 when Ctrl-C stops it. 1 is a fault
of ours, with its traceback; `GAMBOL_TRACEBACK=1` in the environment shows one for mistakes, too.

What is compiled and learnt is kept in the user's folder of caches, `~/.cache/gambol` on Linux, or in the one that `GAMBOL_CACHE` names in the
environment; where neither can be written, that is told, and it is made anew each time.
"""


def page() -> str:
    """The page, in Markdown."""
    from gambol.game.cli import app

    return "\n".join([HEAD, *_told("gambol", typer.main.get_command(app))])


def _told(name: str, command: Any) -> Iterator[str]:
    """The lines about a command, or about those of a group."""
    if hasattr(command, "commands"):
        for own, inner in command.commands.items():
            yield from _told(f"{name} {own}", inner)
        return
    arguments = [one for one in command.params if one.param_type_name == "argument"]
    options = [one for one in command.params if one.param_type_name == "option"]
    yield f"## `{' '.join([name, *map(_argument, arguments)])}`\n\n{' '.join(command.help.split())}\n"
    yield "| | what it is | left out |\n|---|---|---|"
    for one in arguments:
        yield f"| `{_named(one)}` | {_plain(one.help)} | {_default(one)} |"
    for one in options:
        yield f"| `{'`, `'.join([*one.opts, *one.secondary_opts])}` | {_plain(one.help)} | {_default(one)} |"
    yield ""


def _named(argument: Any) -> str:
    return (argument.metavar or argument.name).strip("{}[]").upper()


def _argument(argument: Any) -> str:
    return _named(argument) if argument.required else f"[{_named(argument)}]"


def _plain(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _default(one: Any) -> str:
    if one.required:
        return "needed"
    value = one.default.value if isinstance(one.default, Enum) else one.default
    if value is None or value is False or value == () or "by default" in one.help:
        return "–"
    return "yes" if value is True else f"`{value}`"


if __name__ == "__main__":
    print(page(), end="")
