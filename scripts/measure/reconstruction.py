"""Measure the reconstruction of whole bodies from a few points: Tables 1 and 2 and Figure 3 of Mousas 2014, and more.

    python scripts/measure/reconstruction.py FOLDER [--large FOLDER] [--only table1,table2,...] [--out FOLDER]

FOLDER: motion files, or a database built from them. --large: the same files and many more. What was measured once is
kept in --cache, so that starting again costs nothing; --out writes the tables, and plots (the `report` extra), there.
All distances are centimetres in the world over 19 joints, of whole takes that nothing was learnt from, each method
running on its own output after half a second of known motion. In brackets stand 95 % bootstrap intervals over takes.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")  # before numpy: threads cost small matrices far more than they save

import numpy as np

from gambol.controllers.compiled import cache_folder
from gambol.controllers.reconstruction.database import DatabaseError
from gambol.controllers.reconstruction.regression import SPAN
from reconstruction_bench import Bench, Course, Courses, lost_from
from reconstruction_figures import PRINTED, PRINTED_SIZES, TRACKERS, Figures, against, bars, figures, lines, table
from reconstruction_methods import BASE, OURS, RIVALS

SETS = ("2", "3", "4", "5", "6", "liu")
NOISE, HIDDEN = 0.01, 0.5
"""Of the points' coordinates [m]; how long each point is lost [s]."""
HEAD = ("", "cm", "ours - this [95 %]", "/ LPCR", "aligned cm", "joint deg", "dof deg", "points cm", "jitter", "lag",
        "worst cm", "lost %")
"""What the long tables tell of a method; see `Figures`."""


class Comparison:
    """The sections, each a text; figures are made of outcomes when they are asked for."""

    def __init__(self, bench: Bench, on: Courses, methods: list[str], sets: list[str], out: Path | None):
        self.bench, self.on, self.methods, self.sets, self.out = bench, on, methods, sets, out

    def of(self, name: str, course: str, points: str, **more) -> Figures:
        """A method's figures on a course."""
        return figures(self.bench.outcomes(name, getattr(self.on, course), points, **more), points)

    def row(self, name: str, found: Figures, ours: Figures, base: Figures) -> list[str]:
        """What Table 1 says of a method."""
        return [name, f"{found.position.mean():.2f}", "" if found is ours else against(ours.position, found.position),
                f"{found.position.mean() / base.position.mean():.2f}", f"{found.aligned.mean():.2f}",
                f"{found.angle.mean():.1f}", f"{found.column.mean():.1f}", f"{found.residual.mean():.2f}",
                f"{found.shake:.1f}", f"{found.lag.mean():+.1f}", f"{found.worst.max():.0f}",
                f"{100 * found.lost.sum() / found.frames.sum():.1f}"]

    def table1(self) -> str:
        """Methods by control points."""
        parts, means = [], {name: [] for name in self.methods}
        for points in self.sets:
            found = {name: self.of(name, "seen", points) for name in self.methods}
            for name in self.methods:
                means[name].append(float(found[name].position.mean()))
            parts.append(f"### {_points(points)}\n\n" + table(HEAD, [
                self.row(name, found[name], found[OURS], found[BASE]) for name in self.methods]))
        numbered = [k for k, points in enumerate(self.sets) if points.isdigit()]
        ratios = []
        for name in self.methods:
            ratio = [means[name][k] / means[BASE][k] for k in numbered]
            printed = PRINTED.get(RIVALS[name].printed)
            ratios.append([name, *(f"{value:.2f}" + (f" ({printed[int(self.sets[k]) - 2] / PRINTED[BASE][int(self.sets[k]) - 2]:.2f})"
                                                     if printed else "") for value, k in zip(ratio, numbered, strict=True))])
        summary = table(["cm", *self.sets], [[name, *(f"{value:.2f}" for value in means[name])] for name in self.methods])
        ratio = table(["ratio to LPCR (paper's)", *(self.sets[k] for k in numbered)], ratios)
        if self.out:
            lines(self.out / "table1.png", [self.sets[k] for k in numbered],
                  {name: [means[name][k] for k in numbered] for name in self.methods},
                  "Takes that were not learnt from, of seen subjects", "control points")
        return "\n\n".join([self.about("seen"), summary, ratio, *parts])

    def table2(self) -> str:
        """A small database against a large one."""
        parts = []
        for pair, points in ((("actions", "actions_large"), "6"), (("actions", "actions_large"), "4"),
                             (("seen", "seen_large"), "4")):
            rows = []
            for name in self.methods:
                small, large = (self.of(name, course, points).position for course in pair)
                printed = PRINTED_SIZES.get(RIVALS[name].printed)
                rows.append([name, f"{small.mean():.2f}", f"{large.mean():.2f}", against(large, small),
                             f"{large.mean() / small.mean():.2f}", f"{printed[1] / printed[0]:.2f}" if printed else ""])
            head = ["", *(f"{len(getattr(self.on, course).learnt):,} poses" for course in pair), "difference [95 %]", "ratio", "paper's ratio"]
            parts.append(f"### {_points(points)}, {getattr(self.on, pair[0]).name}\n\n" + table(head, rows))
        return "\n\n".join([self.about("actions"), *parts])

    def figure3(self) -> str:
        """Methods by action."""
        actions = [take.action for take in self.on.actions.takes]
        names, parts = list(dict.fromkeys(actions)), [self.about("actions")]
        for points in ("6", "4"):
            means = {}
            for name in self.methods:
                position = self.of(name, "actions", points).position
                means[name] = [float(np.mean(position[[a == action for a in actions]])) for action in names]
            parts.append(f"### {_points(points)}\n\n" + table(["cm", *names, "mean"], [
                [name, *(f"{value:.2f}" for value in row), f"{np.mean(row):.2f}"] for name, row in means.items()]))
            if self.out:
                bars(self.out / f"figure3_{points}.png", names, means, f"Figure 3: {_points(points)}")
        return "\n\n".join(parts)

    def subjects(self) -> str:
        """People nothing was learnt from."""
        of = np.array([take.subject for take in self.on.strangers.takes])
        found = {name: self.of(name, "strangers", "4") for name in self.methods}
        by_subject = table(["cm", *(f"subject {who}" for who in np.unique(of))], [
            [name, *(f"{one.position[of == who].mean():.2f}" for who in np.unique(of))] for name, one in found.items()])
        return "\n\n".join([self.about("strangers"), by_subject, table(
            HEAD, [self.row(name, one, found[OURS], found[BASE]) for name, one in found.items()])])

    def noise(self) -> str:
        """Points that shake."""
        rows = []
        for name in self.methods:
            clean, noisy = self.of(name, "seen", "4"), self.of(name, "seen", "4", noise=NOISE)
            rows.append([name, f"{clean.position.mean():.2f}", f"{noisy.position.mean():.2f}", f"{clean.shake:.1f}",
                         f"{noisy.shake:.1f}", f"{noisy.lag.mean():+.1f}", f"{noisy.angle.mean():.1f}"])
        return (f"Normal noise of {100 * NOISE:g} cm on each coordinate of 4 points, anew in each frame.\n\n"
                + table(["", "clean cm", "noisy cm", "clean jitter", "noisy jitter", "lag", "joint deg"], rows))

    def long(self) -> str:
        """A minute on a method's own output."""
        takes, rows = ", ".join(take.clip for take in self.on.minute.takes), []
        if not takes:
            return "No take is that long."
        for name in self.methods:
            found = self.of(name, "minute", "4")
            rows.append([name, f"{found.position.mean():.2f}", f"{int(found.lost.sum())}", f"{found.worst.max():.0f}"])
        return (f"{self.about('minute')} {takes}.\n\n"
                + table(["4 points", "cm", f"frames beyond 20 cm, of {int(found.frames.sum())}", "worst cm"], rows))

    def dropout(self) -> str:
        """Points that are lost for a while, and come back."""
        course, rows = self.on.seen, []
        for name in self.methods:
            whole, torn = (self.bench.outcomes(name, course, "4", hidden=hidden) for hidden in (0.0, HIDDEN))
            during, after, calm = [], [], []
            for number, (one, other) in enumerate(zip(whole, torn, strict=True)):
                there, gap = np.arange(SPAN, SPAN + len(one.errors)), round(HIDDEN / one.trial.dt)
                starts = lost_from(len(one.trial.frames), one.trial.points.shape[1], number, HIDDEN, one.trial.dt, self.bench.seed)
                lost = np.any([(there >= first) & (there < first + gap) for first in starts], axis=0)
                back = np.any([(there >= first + gap) & (there < first + 2 * gap) for first in starts], axis=0) & ~lost
                if lost.any() and back.any():
                    during.append(other.errors[lost].mean())
                    after.append(other.errors[back].mean())
                    calm.append(one.errors[lost | back].mean())
            if not calm:
                return "No take is long enough."
            rows.append([name, *(f"{100 * np.mean(values):.2f}" for values in (calm, during, after))])
        return (f"Each of 4 points is lost once for {HIDDEN} s, at a time of its own; {len(calm)} takes are long enough.\n\n"
                + table(["cm", "none lost", "while some are", "half a second after"], rows))

    def tune(self) -> str:
        """What was tried on the validation takes."""
        parts = [self.about("validation")]
        for name in self.methods:
            baseline, rows = RIVALS[name], []
            for settings in baseline.tries(self.bench.seed):
                found = self.of(name, "validation", "4", settings=settings)
                rows.append((found.position.mean(), [*map(str, settings.values()), f"{found.position.mean():.2f}", f"{found.angle.mean():.1f}",
                             "in use" if settings.items() <= dict(baseline.settings).items() else ""]))
            if rows:
                rows = [row for _, row in sorted(rows, key=lambda one: one[0])]
                parts.append(f"### {name}\n\n" + table([*baseline.grid, "cm", "joint deg", ""], rows))
        return "\n\n".join([*parts, TRACKERS])

    def time(self) -> str:
        """A frame, all in: neighbours, prior and solver."""
        rows, sets = [], [points for points in self.sets if points in ("4", "6")]
        for name in self.methods:
            cells = [name]
            for course in ("seen", "seen_large"):
                for points in sets:
                    times = 1e3 * self.bench.times(name, getattr(self.on, course), points)
                    clock, own = times.T
                    cells.append(f"{np.median(clock):.2f} ({np.quantile(clock, 0.99):.2f}), {own.mean():.2f}")
            rows.append(cells)
        sizes = [f"{len(getattr(self.on, course).learnt):,} poses, {points} points" for course in ("seen", "seen_large") for points in sets]
        return ("Milliseconds of a frame on one thread: the median, what one in a hundred is beyond, and the mean of the "
                "process's own time, which others on the machine hardly change.\n\n") + table(["", *sizes], rows)

    def about(self, course: str) -> str:
        """What a course is."""
        on: Course = getattr(self.on, course)
        return f"{len(on.takes)} takes, {on.name}; {len(on.learnt):,} poses to learn from, mirror images included."


SECTIONS = {"table1": "Table 1", "table2": "Table 2", "figure3": "Figure 3", "subjects": "Unseen subjects", "noise": "Noise on the points",
            "long": "A minute", "dropout": "Lost points", "tune": "Tuning", "time": "Time"}


def _points(points: str) -> str:
    return "Liu's 6 points" if points == "liu" else f"{points} points"


def _chosen(text: str | None, known: list[str], what: str) -> list[str]:
    """Names from a text with commas, in the known order; all by default."""
    names = known if text is None else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in known:
            sys.exit(f"no {what} {name!r}: there are {', '.join(known)}")
    return [name for name in known if name in names]


def main() -> None:
    """Print the sections, and write them down if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("motion", type=Path, metavar="FOLDER", help="motion files, or a database")
    parser.add_argument("--large", type=Path, metavar="FOLDER", help="the same and many more, for Table 2; by default FOLDER itself")
    parser.add_argument("--only", help=f"some of {','.join(SECTIONS)}")
    parser.add_argument("--methods", help="some of the methods; LPCR and ours are always among them")
    parser.add_argument("--points", help=f"some of the control points of Table 1 and of the times: {','.join(SETS)}")
    parser.add_argument("--out", type=Path, help="where tables (.md) and plots (.png) are written")
    parser.add_argument("--cache", type=Path, default=cache_folder().parent / "measured", help="where outcomes are kept")
    parser.add_argument("--takes", type=int, default=22, help="how many takes are tested on; half as many are tuned on")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    wanted = _chosen(options.only, list(SECTIONS), "section")
    methods = _chosen(options.methods and f"{options.methods},{BASE},{OURS}", list(RIVALS), "method")
    sets = _chosen(options.points, list(SETS), "set of points")
    if options.out:
        options.out.mkdir(parents=True, exist_ok=True)
    bench = Bench(options.cache, options.seed)
    try:
        with bench.progress:
            main_, large = bench.database(options.motion), bench.database(options.large or options.motion)
            comparison = Comparison(bench, Courses(main_, large, options.takes, options.seed), methods, sets, options.out)
            for name in wanted:
                text = f"## {SECTIONS[name]}\n\n{getattr(comparison, name)()}\n"
                print(f"\n{text}", flush=True)
                if options.out:
                    (options.out / f"{name}.md").write_text(text)
    except DatabaseError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
