"""All that a scenario may say, as a page: every table with what its docstring tells, and every field with its default."""

from __future__ import annotations

import inspect
from typing import Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from .fields import Table
from .scenario import Scenario, tables_of

HEAD = """# All fields of a scenario

`gambol scenarios --fields` prints this page. A table in double brackets may be there several times; any of them may also stand
in one line, as `moves = [{ for = 2, stop = true }]`.
"""


def described() -> str:
    """The page, in Markdown."""
    lines, waiting = [HEAD], [("", Scenario)]
    while waiting:
        path, table = waiting.pop(0)
        inner = [(_name(own, field), one) for own, field in table.model_fields.items() for one in tables_of(field.annotation)]
        waiting += [(f"{path}.{own}".strip("."), one) for own, one in inner]
        lines += [_heading(path, table), "", told(table), "", "| field | left out |", "|---|---|"]
        lines += [f"| `{_name(own, field)}` | {_default(field, own in dict(inner))} |" for own, field in table.model_fields.items()]
        lines.append("")
    return "\n".join(lines)


def told(table: type[Table]) -> str:
    """What a table's docstring tells, and those of what it is made from."""
    return " ".join(" ".join(inspect.cleandoc(one.__doc__ or "") for one in table.__mro__ if issubclass(one, Table) and one is not Table).split())


def _heading(path: str, table: type[Table]) -> str:
    kind = f", {get_args(table.model_fields['kind'].annotation)[0]}" if path == "props" else ""
    return f"## `{path}`{kind}" if path else "## At the top"


def _name(own: str, field: FieldInfo) -> str:
    return field.alias or own


def _default(field: FieldInfo, holds_tables: bool) -> str:
    if get_origin(field.annotation) is Literal and len(get_args(field.annotation)) == 1:
        return f'`"{get_args(field.annotation)[0]}"`{", needed" * field.is_required()}'
    if field.is_required():
        return "needed"
    if field.default is None or holds_tables or field.default == ():
        return "–"
    value = field.default
    if isinstance(value, bool):
        return f"`{value}`".lower()
    if isinstance(value, tuple):
        return f"`[{', '.join(f'{v:g}' if isinstance(v, int | float) else repr(v) for v in value)}]`".replace("'", '"')
    return f"`{value:g}`" if isinstance(value, int | float) else f'`"{value}"`'
