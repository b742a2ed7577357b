"""Runs a program on every input with every combination of settings, each in a process of its own, and
prints the rows of figures that come out.

What follows -- is passed on to the program; a value with commas is a list, as in --drift-bound 0.1,0.25,inf,
and each run gets one of its items. With several combinations and --output each writes its mesh into a
folder of its own.

    run.py build/release/.../rco_benchmark *.off -- --method ours,plain,paper --check

Exit code: the worst of the programs'; 0, 1 if a check failed, 2 if a run failed or crashed.
"""

import argparse
import concurrent.futures
import csv
import itertools
import json
import math
import os
import signal
import subprocess
import sys


def run(command, seconds=math.inf, megabytes=math.inf):
    """how a program ended: its exit code, negative if a signal ended it, and what it wrote

    Seconds are the processor's, which other programs do not lengthen; one that waits for ever uses none, and
    is ended after five times as many.
    """
    limits = ["ulimit -c 0"]
    if seconds < math.inf:
        limits.append(f"ulimit -S -t {math.ceil(seconds)}")
    if megabytes < math.inf:
        limits.append(f"ulimit -v {round(1024 * megabytes)}")
    shell = ["sh", "-c", "; ".join(limits) + '; exec "$@"', "sh"] if os.name == "posix" else []
    try:
        return subprocess.run(shell + command, capture_output=True, text=True, errors="replace",
                              timeout=5 * seconds if seconds < math.inf else None)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, -signal.SIGXCPU, "", "")


def run_all(commands, processes=1, **limits):
    """the same of each command, in their order"""
    with concurrent.futures.ThreadPoolExecutor(processes) as pool:
        yield from pool.map(lambda command: run(command, **limits), commands)


def failure(ended):
    """why there is no row, in words; nothing if there is one"""
    if ended.returncode < 0:
        is_time_out = ended.returncode == -signal.SIGXCPU
        return "time limit" if is_time_out else f"ended by signal {-ended.returncode}"
    return "" if ended.stdout else ended.stderr.strip() or "ended without a result"


def print_rows(rows, form, columns=None):
    """as lines of JSON, as CSV or as a table"""
    if form == "json":
        for row in rows:
            print(json.dumps(row), flush=True)
        return
    rows = list(rows)
    columns = columns or list(dict.fromkeys(key for row in rows for key in row))
    if form == "csv":
        writer = csv.DictWriter(sys.stdout, columns, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
        return

    def text(x):
        return "-" if x is None else f"{x:.4g}" if isinstance(x, float) and x % 1 else f"{x}"

    lines = [columns] + [[text(row.get(c)) for c in columns] for row in rows]
    widths = [max(map(len, column)) for column in zip(*lines)]
    for line in lines:
        print("  ".join(word.rjust(width) for word, width in zip(line, widths)))


def new_parser(description):
    """with the options of all scripts that print rows"""
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--format", choices=("table", "csv", "json"), default="table",
                        help="JSON comes a line a row, as soon as a run has ended")
    parser.add_argument("--columns", type=lambda text: text.split(","), metavar="LIST",
                        help="only these columns of a table or of CSV")
    parser.add_argument("--processes", type=int, default=1, metavar="N",
                        help="runs at once (default 1)")
    parser.add_argument("--output", metavar="DIR", help="folder for the resulting meshes")
    return parser


def combinations(settings):
    """the settings with one item of each list, and the items by which combinations differ, by option"""
    lists = [text.split(",") for text in settings]
    for items in itertools.product(*lists):
        yield list(items), {settings[i - 1].lstrip("-"): items[i] for i in range(len(items))
                            if len(lists[i]) > 1}


def main():
    parser = new_parser(__doc__)
    parser.add_argument("--cpu-limit", type=float, default=math.inf, metavar="S",
                        help="seconds of processor time of a run")
    parser.add_argument("--memory-limit", type=float, default=math.inf, metavar="MB",
                        help="address space of a run")
    parser.add_argument("program")
    parser.add_argument("input", nargs="+")
    arguments, settings = sys.argv[1:], []
    if "--" in arguments:
        arguments, settings = (arguments[:arguments.index("--")],
                               arguments[arguments.index("--") + 1:])
    o = parser.parse_args(arguments)

    runs = list(itertools.product(o.input, combinations(settings)))
    commands = []
    for name, (setting, chosen) in runs:
        command = [os.path.abspath(o.program), name, *setting]
        if o.output:
            folder = os.path.join(o.output, "_".join(f"{k}={v}" for k, v in chosen.items()))
            os.makedirs(folder, exist_ok=True)
            command += ["--output", folder]
        commands.append(command)
    worst = 0

    def rows():
        nonlocal worst
        ends = run_all(commands, o.processes, seconds=o.cpu_limit, megabytes=o.memory_limit)
        for (name, (_, chosen)), ended in zip(runs, ends):
            why = failure(ended)
            worst = max(worst, 2 if why else ended.returncode)
            if why:
                print(" ".join([name, *chosen.values()]) + ": " + why, file=sys.stderr)
            else:
                yield chosen | json.loads(ended.stdout)

    print_rows(rows(), o.format, o.columns)
    sys.exit(worst)


if __name__ == "__main__":
    main()
