"""Runs the package and its peers on the same meshes, compares them, and prints a row of figures for each.

What the methods and the columns are is told by the program's --help. Two columns are added. better: who
is better, that is, not worse in theta (min and mean), drift, flips and folds, better in one of them, at no
more time; remesh, which changes the connectivity, is exempt. wins: the columns in which the method is
ahead of the package. Charts are made of the rows, as lines of JSON, by scripts/figures/charts.py.

Exit code: 0, 1 if a check failed, 2 if a mesh could not be used.
"""

import json
import os
import sys

sys.dont_write_bytecode = True
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from run import failure, new_parser, print_rows, run_all  # noqa: E402

METHODS = ("input", "package", "plain", "stars1", "stars10", "soft", "angles", "angles_safe", "relax",
           "relax_guarded", "remesh")


def compare(a, b):
    """whether a row is better than another, and the columns that it wins"""
    wins, loses = [], False
    for column, sign in (("theta_min", -1), ("theta_mean", -1), ("drift", 1), ("flips", 1), ("folds", 1)):
        x, y = sign * a[column], sign * b[column]
        rounding = 1e-9 * max(1, abs(y))
        if x < y - rounding:
            wins.append(column)
        elif x > y + rounding:
            loses = True
    is_better = bool(wins) and not loses and a["time_s"] <= b["time_s"]
    return is_better, wins + ["time"] * (a["time_s"] < b["time_s"])


def main():
    parser = new_parser(__doc__)
    parser.add_argument("--methods", type=lambda text: text.split(","), default=METHODS, metavar="LIST",
                        help="the input and the package are always there")
    parser.add_argument("--time-limit", type=float, default=600, metavar="S",
                        help="seconds for each method (default 600); what has not ended by itself a "
                        "while after that is ended")
    parser.add_argument("--check", action="store_true", help="fail if a peer is better than the package")
    parser.add_argument("program")
    parser.add_argument("mesh", nargs="+")
    o = parser.parse_args()
    unknown = set(o.methods) - set(METHODS)
    if unknown:
        parser.error("there is no method " + unknown.pop())
    runs = [(mesh, method) for mesh in o.mesh for method in METHODS
            if method in o.methods or method in ("input", "package")]
    commands = [[os.path.abspath(o.program), mesh, "--method", method, "--time-limit", str(o.time_limit)]
                + (["--output", o.output] if o.output else []) for mesh, method in runs]
    worst = 0

    def rows():
        nonlocal worst
        # the figures take time, too
        ends = run_all(commands, o.processes, seconds=1.5 * o.time_limit + 60)
        package = None
        for (mesh, method), ended in zip(runs, ends):
            why = failure(ended)
            row = {"mesh": os.path.splitext(os.path.basename(mesh))[0], "method": method, "note": why}
            if not why:
                row = json.loads(ended.stdout)
            elif method == "input":
                print(f"{mesh}: {why}", file=sys.stderr)
                worst = 2
            elif method == "package" and o.check:
                worst = max(worst, 1)
            if method == "package":
                package = None if why else row
            elif method != "input" and package and not why:
                is_better, wins = compare(row, package)
                row["better"] = ("exempt" if method == "remesh" else "peer" if is_better
                                 else "package" if compare(package, row)[0] else "neither")
                row["wins"] = " ".join(wins)
                if o.check and row["better"] == "peer":
                    worst = max(worst, 1)
            yield row

    print_rows(rows(), o.format, o.columns)
    sys.exit(worst)


if __name__ == "__main__":
    main()
