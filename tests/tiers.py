"""Which tests are left out unless all are wanted: those that are marked `thorough`, and cases of families that are marked `few`."""

from pathlib import Path


def left_out(items, named):
    """Those of pytest's items that are not run; named: what the command line names, whose files run whole."""
    files = {Path(name.split("::")[0]).resolve() for name in named}
    families = {}
    for item in items:
        if item.get_closest_marker("few"):
            families.setdefault((item.path, item.originalname), []).append(item)
    kept = {item for cases in families.values() for item in _spread(cases)}
    return {item for item in items if item.path not in files
            and (item.get_closest_marker("thorough") or item.get_closest_marker("few") and item not in kept)}


def _spread(cases):
    """Those of a test's cases that are tried in any case: as many as its mark says, the first and the last among them."""
    count = min(cases[0].get_closest_marker("few").args[0], len(cases))
    return {cases[round(k * (len(cases) - 1) / max(count - 1, 1))] for k in range(count)}
