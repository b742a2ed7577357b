"""Runs the package on everything, and tells how the runs ended.

Optimizes every mesh (OFF, OBJ, PLY, STL) of files and folders, and small generated inputs with something
wrong: as they are, times 2^-20, 2^20, 1e-6 and 1e6, translated by 1e6 diagonals, with another random seed,
and with random noise of up to 0.3 mean edges against the mesh without it. Each run has a process of its
own. How it ended is compared with what is expected, and what the package guarantees is verified. Times a
power of two all digits of the smallest angles must be the same. How far they change in other units and far
away is told, beside what another random seed does. Markdown tables and a list of all that is not as expected go to
the standard output.

Exit code: 0, 1 if a run was not as expected, 2 if an option could not be used.
"""

import argparse
import collections
import json
import os
import re
import signal
import statistics
import sys

sys.dont_write_bytecode = True
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from run import failure, run_all  # noqa: E402

Variant = collections.namedtuple("Variant", "name options kind", defaults=("", None))
# a power of two leaves all digits as they are: the result has to be the same to the last one
VARIANTS = (
    Variant("as is"),
    Variant("times 2^-20", f"--scale {2 ** -20!r}", "exact"),
    Variant("times 2^20", "--scale 1048576", "exact"),
    Variant("times 1e-6", "--scale 1e-6", "rounded"),
    Variant("times 1e6", "--scale 1e6", "rounded"),
    Variant("1e6 diagonals away", "--shift 1e6", "rounded"),
    Variant("another seed", "--seed 1", "seed"),
    Variant("noise", "--noise 0.3"),
)
OUTCOMES = ("improved", "nothing to do", "refused", "no mesh", "violated guarantee", "exception", "memory",
            "time-out", "crash")

# `arguments` are those that make the program read or generate the input
Input = collections.namedtuple("Input", "kind name arguments")


def parse():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--generated", action="store_true", help="the generated inputs, too")
    parser.add_argument("--filter", default="", metavar="TEXT",
                        help="only inputs whose name contains TEXT")
    parser.add_argument("--variants", type=lambda text: text.split(","), metavar="LIST",
                        default=[v.name for v in VARIANTS],
                        help="of: " + ", ".join(v.name for v in VARIANTS))
    parser.add_argument("--max-faces", type=int, default=30000, metavar="N",
                        help="leave larger meshes out (default 30000)")
    parser.add_argument("--time-limit", type=float, default=120, metavar="S",
                        help="seconds of processor time of a run (default 120)")
    parser.add_argument("--memory-limit", type=float, default=4096, metavar="MB",
                        help="address space of a run (default 4096; inf: no limit)")
    parser.add_argument("--processes", type=int, default=1, metavar="N", help="runs at once (default 1)")
    parser.add_argument("--flattened", action="store_true",
                        help="without on-surface steps and finishing stage")
    parser.add_argument("--relax-constraints", action="store_true",
                        help="vertices slide along borders")
    parser.add_argument("--list", action="store_true", help="a row for each run, too")
    parser.add_argument("program")
    parser.add_argument("path", nargs="*", help="mesh, or folder of meshes")
    o = parser.parse_args()
    for name in o.variants:
        if name not in [v.name for v in VARIANTS]:
            parser.error(f"--variants: there is no '{name}'")
    for path in o.path:
        if not os.path.exists(path):
            parser.error("there is no " + path)
    if not o.generated and not o.path:
        parser.error("neither a path nor --generated")
    return o


def find_files(paths):
    extensions = (".off", ".obj", ".ply", ".stl")
    for path in paths:
        if not os.path.isdir(path):
            yield path
        for folder, _, names in os.walk(path):
            yield from (os.path.join(folder, n) for n in names if n.lower().endswith(extensions))


def print_list(what, names):
    if names:
        print(f"\n{what}: {len(names)}", *("- " + name for name in names), sep="\n")


def print_table(head, lines):
    print("\n" + " | ".join(head) + "\n---" + "|--:" * (len(head) - 1))
    for line in lines:
        print(" | ".join(map(str, line)))


class Runner:
    def __init__(self, o):
        self.o = o
        self.program = os.path.abspath(o.program)

    def run(self, arguments):
        """of each list of arguments, what the program told"""
        ends = run_all(([self.program, *a] for a in arguments), self.o.processes,
                       seconds=self.o.time_limit, megabytes=self.o.memory_limit)
        for ended in ends:
            if not failure(ended):
                yield json.loads(ended.stdout)
            elif ended.returncode == -signal.SIGXCPU:
                yield {"outcome": "time-out", "text": ""}
            else:
                yield {"outcome": "crash", "text": failure(ended)}

    def generated(self):
        names = next(self.run([["--names"]]))["names"].split("|")
        return [Input("Generated inputs", n, ("--generated", n)) for n in names if self.o.filter in n]

    def files(self):
        paths = sorted(p for p in find_files(self.o.path) if self.o.filter in os.path.basename(p))
        surveys = list(zip(paths, self.run([path, "--survey"] for path in paths)))
        name = os.path.basename
        print_list("Oriented and split where they are not manifold, to be read at all",
                   [name(path) for path, s in surveys if s.get("is_repaired")])
        print_list(f"Left out, more than {self.o.max_faces} faces",
                   [f"{name(path)} ({s['faces']} faces)" for path, s in surveys
                    if s.get("faces", 0) > self.o.max_faces])
        for path, s in sorted(surveys, key=lambda pair: pair[1].get("faces", 0)):
            if s.get("faces", 0) <= self.o.max_faces:
                yield Input("Meshes from files", name(path), (path,))
                if s.get("has_polygons") and s["faces"] > 0:
                    yield Input("Meshes from files", name(path) + ", triangulated",
                                (path, "--triangulate"))


def angles(row, when="out"):
    return row[f"theta_min_{when}"], row[f"theta_mean_{when}"]


def main():
    o = parse()
    runner = Runner(o)
    inputs = (runner.generated() if o.generated else []) + list(runner.files())
    variants = [v for v in VARIANTS if v.name in o.variants]
    switches = ["--flattened"] * o.flattened + ["--relax-constraints"] * o.relax_constraints
    jobs = [(i, v) for i in inputs for v in variants]
    if o.list:
        print("\ninput | variant | faces | outcome | min, mean angle before | after | s |"
              "\n---|---|--:|---|---|---|--:|---")
    counts, refusals = collections.Counter(), collections.Counter()
    as_is, changes = {}, collections.defaultdict(list)
    unexpected, fallen = [], 0
    for (i, v), row in zip(jobs, runner.run([*i.arguments, *v.options.split(), *switches]
                                            for i, v in jobs)):
        where, outcome, text = f"{i.name} ({v.name})", row["outcome"], row["text"]
        counts[i.kind, v.name, outcome] += 1
        if outcome == "refused":  # without numbers and details
            refusals[re.sub(r"\d+(\.\d+)?", "N", re.split("[,;(]", text)[0])] += 1
        if not row.get("is_expected"):
            unexpected.append(f"{where}: {outcome}: {text}")
        if o.list:
            figures = ("{:.2f} {:.2f} | {:.2f} {:.2f} | {:.2f}".format(
                *angles(row, "in"), *angles(row), row["time_s"]) if row.get("theta_min_out") is not None
                else "- | - | -")
            print(f"{i.name} | {v.name} | {row.get('faces', '-')} | {outcome} | {figures} | {text}",
                  flush=True)
        if outcome not in ("improved", "nothing to do"):
            continue
        fallen += row["theta_mean_out"] < row["theta_mean_in"] - 1
        if v.name == "as is":
            as_is[i] = angles(row)
        if v.kind is None or i not in as_is:
            continue
        gains = [a - b for a, b in zip(angles(row), as_is[i])]
        changes[v.name].append(gains)
        if v.kind == "exact" and gains != [0, 0]:
            unexpected.append(where + ": other angles than as is")

    for kind in dict.fromkeys(i.kind for i in inputs):
        print_table([kind, *OUTCOMES],
                    [[v.name] + [counts[kind, v.name, outcome] for outcome in OUTCOMES] for v in variants])
    if refusals:
        print_table(["Refused because", "runs"], sorted(refusals.items()))
    if changes:
        lines = []
        for name, gains in changes.items():
            sizes = [max(map(abs, g)) for g in gains]
            minima, means = zip(*gains)
            lines.append([name, len(gains), sum(abs(x) >= 0.1 for x in minima),
                          sum(abs(x) >= 0.1 for x in means), f"{statistics.median_high(sizes):.3f}",
                          f"{max(sizes):.2f}", f"{statistics.fmean(minima):.2f}",
                          f"{statistics.fmean(means):.2f}"])
        print_table(["Angles against the run as is", "runs", "minimum changed by 0.1 degrees",
                     "mean changed", "median change", "largest", "minimum gains on average",
                     "mean gains on average"], lines)
    print("\nThe mean of the smallest angles fell by more than a degree, for the sake of the worst, in "
          f"{fallen} runs.")
    print_list("Not as expected", unexpected)
    if not unexpected:
        print("\nAll is as expected.")
    sys.exit(1 if unexpected else 0)


if __name__ == "__main__":
    main()
