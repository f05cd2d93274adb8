"""`gambol jump`: fit how people carry themselves in a jump."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .base import Mistake, app, plainly, say

jump = typer.Typer(no_args_is_help=True, help="Jumps: fit how people carry themselves in them.")
app.add_typer(jump, name="jump")


@jump.command()
@plainly
def build(folder: Annotated[Path, typer.Argument(help="A folder of motion capture, as the fitted takes lie in it.")],
          out: Annotated[Path, typer.Option("-o", "--out", help="The file to write.")] = Path("jumps.npz")) -> None:
    """Fit the prior of jumps to the recorded ones of a folder."""
    from gambol.controllers.jump import Physique
    from gambol.controllers.jump.prior import fit, recorded_jumps, save

    from ..files import named, output_file

    output_file(out, ".npz")
    body = Physique()
    found, notes = recorded_jumps(folder, body.skeleton, body.anatomy)
    try:
        prior = fit(found)
    except ValueError as error:
        raise Mistake("; ".join([f"{folder}: {error}", *notes[:3]])) from None
    with named(out):
        save(prior, out)
    for line in notes:
        say(line)
    both = sum(one.single is None for one in found)
    say(f"{both} jumps off both feet and {len(found) - both} off one, of {len(prior.takes)} takes")
    say(str(out))
