"""Draws charts from the rows of figures that the benchmarks print as lines of JSON.

usage: charts.py KIND ROWS CHART...

KIND      ROWS come from
scaling   run.py scaling_benchmark MESH -- --level -1,0,1,2,3 --threads 1,2
energy    run.py rco_benchmark MESH... -- --history --method ours,plain --finishing 0 --drift-bound inf
bound     run.py rco_benchmark MESH... -- --drift-bound 0.1,0.15,0.25,0.5,1,inf
exponent  run.py rco_benchmark MESH... -- --exponent 1,2,5 --finishing 1,0
peers     side_by_side.py; two charts

For scaling the exponent p for which the time grows with the number n of vertices as n^p is printed, by
least squares over the sizes of 100000 vertices and more, and the speed-up against one thread.
"""

import json
import math
import statistics
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

plt.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "charts", "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "DejaVu Sans"], "font.size": 9, "axes.grid": True,
    "axes.axisbelow": True, "axes.edgecolor": "#777777", "grid.color": "#e3e3e3", "legend.frameon": False,
    "lines.markersize": 5, "lines.linewidth": 1.2, "figure.titleweight": "bold",
})
COLOURS = ("#1d4f8c", "#d9822b", "#3c8d5a", "#8a4fa3", "#b33a3a", "#555555")
MARKS = "osD^v+"

# of the methods: name, colour, mark, whether it is filled
METHODS = {
    "input": ("input", "#888888", "x", False),
    "package": ("package", "#d1202f", "o", True),
    "plain": ("paper's pipeline", "#d1202f", "o", False),
    "stars1": ("star smoother, s = 1", "#1f5fb4", "s", False),
    "stars10": ("star smoother, s = 10", "#1f5fb4", "s", True),
    "soft": ("soft constraint", "#2a8f4f", "D", True),
    "angles": ("CGAL angle smoothing", "#e08214", "^", False),
    "angles_safe": ("CGAL angle smoothing, safe", "#e08214", "^", True),
    "relax": ("CGAL relaxation", "#7b4ba0", "v", False),
    "relax_guarded": ("CGAL relaxation, guarded", "#7b4ba0", "v", True),
    "remesh": ("CGAL isotropic remeshing", "#00a0a8", "+", False),
}


def new_figure(title, names, x_label, columns=4):
    """with a panel of each name"""
    columns = min(columns, len(names))
    lines = math.ceil(len(names) / columns)
    figure, axes = plt.subplots(lines, columns, figsize=(3.3 * columns, 2.7 * lines + 0.3),
                                squeeze=False, layout="constrained")
    figure.suptitle(title)
    for axis in axes.flat[len(names):]:
        axis.set_visible(False)
    for axis, name in zip(axes.flat, names):
        axis.set_title(name, fontsize=9)
        axis.set_xlabel(x_label)
    return figure, list(axes.flat[:len(names)])


def log_axis(axis, ticks):
    axis.set_xscale("log")
    axis.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axis.set_xticks([], minor=True)


def save(figure, file):
    """with one legend for all panels"""
    marks = {}
    for axis in figure.axes:
        marks.update(zip(*reversed(axis.get_legend_handles_labels())))
    figure.legend(marks.values(), marks.keys(), loc="upper center", bbox_to_anchor=(0.5, 0),
                  ncol=min(len(marks), max(2, round(figure.get_figwidth() / 2.2))))
    figure.savefig(file, bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)


def of_each(rows, key):
    """the values of a column in the order in which they appear, each with its rows"""
    return {value: [r for r in rows if r[key] == value] for value in dict.fromkeys(r[key] for r in rows)}


def scaling(rows, file):
    rows = sorted((r for r in rows if r["status"] != "time limit"), key=lambda r: r["vertices"])
    figure, axes = new_figure(rows[0]["mesh"], ("time (s)", "time per vertex (µs)"), "vertices")
    seconds = {(r["vertices"], r["threads"]): r["time_s"] for r in rows}
    for colour, (threads, own) in zip(COLOURS, of_each(rows, "threads").items()):
        name = f"{threads} thread" + "s" * (threads > 1)
        sizes = [r["vertices"] for r in own]
        for axis, column in zip(axes, ("time_s", "us_per_vertex")):
            axis.loglog(sizes, [r[column] for r in own], "o-", color=colour, label=name)
        large = [(math.log(n), math.log(r["time_s"])) for n, r in zip(sizes, own) if n >= 1e5]
        speed_ups = [f"{seconds[n, 1] / r['time_s']:.2f}" for n, r in zip(sizes, own) if (n, 1) in seconds]
        print(f"{name}: " + (f"time ~ n^{statistics.linear_regression(*zip(*large)).slope:.3f}"
                             if len(large) > 1 else "too few large sizes for an exponent")
              + ", speed-up " + " ".join(speed_ups))
    first, last = rows[0]["vertices"], rows[-1]["vertices"]
    start = rows[0]["time_s"]
    axes[0].loglog((first, last), (start, start * last / first), "--", color="#222222", linewidth=0.8,
                   label="proportional")
    save(figure, file)


def energy(rows, file):
    at_rest = math.exp(2)
    meshes = of_each(rows, "mesh")
    figure, axes = new_figure("What is left of the energy while time passes", list(meshes), "seconds")
    axes[0].set_ylabel("mean density above that at rest")
    for axis, own in zip(axes, meshes.values()):
        for colour, row in zip(COLOURS, own):
            axis.loglog(row["history_seconds"], [e - at_rest for e in row["history_energies"]], "o-",
                        color=colour, markersize=3,
                        label="default" if row["method"] == "ours" else "flattened alone")
    save(figure, file)


def bound(rows, file):
    panels = ("smallest angle (degrees)", "mean angle, against no bound (degrees)", "drift (mean edges)")
    figure, axes = new_figure("What the bound on the drift costs and buys", panels,
                              "drift bound (mean edges)")
    for colour, mark, (mesh, own) in zip(COLOURS, MARKS, of_each(rows, "mesh").items()):
        free = next(r for r in own if r["drift-bound"] == "inf")
        own = [r for r in own if r is not free]
        bounds = [float(r["drift-bound"]) for r in own]
        for axis, values in zip(axes, (
            [r["theta_min_out"] for r in own],
            [r["theta_mean_out"] - free["theta_mean_out"] for r in own],
            [max(r["drift_mesh_to_reference"], r["drift_reference_to_mesh"]) for r in own],
        )):
            axis.plot(bounds, values, mark + "-", color=colour, label=mesh)
            log_axis(axis, bounds)
    save(figure, file)


def turn(rows, file):
    """a panel for each mesh: mean angle against mean turn of the faces, over bounds; means over the seeds"""
    meshes = of_each(rows, "mesh")
    figure, axes = new_figure("What a smaller drift bound costs and what turn of the faces it saves", list(meshes),
                              "mean turn of the faces (degrees)", columns=3)
    for axis in axes[::3]:
        axis.set_ylabel("mean smallest angle (degrees)")
    for axis, of_mesh in zip(axes, meshes.values()):
        points = {}
        for bound, own in of_each(of_mesh, "drift-bound").items():
            points[bound] = tuple(statistics.mean(value(r) for r in own) for value in (
                lambda r: r["after"]["mean_normal_deviation"], lambda r: r["after"]["mean_minimum_angle"],
                lambda r: r["number_of_creases"]))
        given = [p for bound, p in points.items() if bound != "default"]
        axis.plot([p[0] for p in given], [p[1] for p in given], "o-", color=COLOURS[0],
                  label="bounds of 0.05, 0.1, 0.15, 0.25, 0.5 edges")
        axis.plot(*points["default"][:2], "*", color=COLOURS[4], markersize=10, label="default; numbers: creases")
        for p in points.values():
            axis.annotate(f"{p[2]:.0f}", p[:2], textcoords="offset points", xytext=(4, -9), fontsize=7)
        creases = of_mesh[0]["initial_number_of_creases"]
        axis.set_title(f"{of_mesh[0]['mesh']} ({creases} creases on input)", fontsize=9)
    save(figure, file)


def exponent(rows, file):
    figure, axes = new_figure("A larger exponent is no substitute for the finishing stage",
                              ("smallest angle (degrees)", "mean angle (degrees)"), "exponent factor")
    for colour, mark, (mesh, of_mesh) in zip(COLOURS, MARKS, of_each(rows, "mesh").items()):
        for finishing, own in of_each(of_mesh, "finishing").items():
            is_on = finishing == "1"
            factors = [float(r["exponent"]) for r in own]
            for axis, column in zip(axes, ("theta_min_out", "theta_mean_out")):
                axis.plot(factors, [r[column] for r in own], mark + ("-" if is_on else "--"),
                          color=colour, fillstyle="full" if is_on else "none",
                          label=mesh + ("" if is_on else ", no finishing"))
                log_axis(axis, factors)
    save(figure, file)


def peers(rows, angles_file, drift_file):
    rows = [r for r in rows if r.get("theta_min") is not None]
    meshes = of_each(rows, "mesh")
    floor = 0.05  # of the drift; what is below is drawn there

    def draw(title, x_label, x, left_out=""):
        figure, axes = new_figure(title, list(meshes), x_label)
        axes[0].set_ylabel("smallest angle (degrees)")
        for axis, own in zip(axes, meshes.values()):
            for r in own:
                name, colour, mark, is_filled = METHODS[r["method"]]
                look = {"markersize": 9, "zorder": 1} if r["method"] == "package" else {}
                if r["method"] != left_out:
                    axis.plot(x(r), r["theta_min"], mark, color=colour, label=name, alpha=0.8,
                              fillstyle="full" if is_filled else "none", **look)
            low, high = axis.get_ylim()
            if own[0]["bound"] <= high + 0.3 * (high - low):
                axis.axhline(own[0]["bound"], linestyle="--", color="#555555", linewidth=0.8,
                             label="estimate of the connectivity's bound")
        return figure, axes

    figure, _ = draw("Smallest angle against mean: up and right is better",
                     "mean over the faces (degrees)", lambda r: r["theta_mean"])
    save(figure, angles_file)
    # it says nothing of the input
    figure, axes = draw("Smallest angle against drift: up and left is better", "drift (mean edges)",
                        lambda r: max(r["drift"], floor), "input")
    for axis in axes:
        log_axis(axis, [t for t in (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10) if t < 1.1 * axis.get_xlim()[1]])
    save(figure, drift_file)


def histogram(title, label, before, after, bins, ideal, unit, file):
    """of two lists of numbers; what is beyond the last bin counts there"""
    figure, (axis,) = new_figure(title, [""], label)
    figure.set_size_inches(5, 3)
    axis.set_ylabel("share (%)")
    for name, values, fill, line in (("before", before, "#d9d4cb", "#8f877a"),
                                     ("after", after, "#2f6db573", "#1d4f8c")):
        axis.hist([min(v, bins[-1]) for v in values], bins, weights=[100 / len(values)] * len(values),
                  histtype="stepfilled", facecolor=fill, edgecolor=line,
                  label=f"{name}: min {min(values):.4g}{unit}, max {max(values):.4g}{unit}, "
                  f"std {statistics.pstdev(values):.3g}{unit}")
    axis.axvline(ideal, linestyle="--", color="#222222", linewidth=0.8, label="ideal")
    save(figure, file)


KINDS = {f.__name__: f for f in (scaling, energy, bound, exponent, peers)}

if __name__ == "__main__":
    if len(sys.argv) < 4 or sys.argv[1] not in KINDS:
        sys.exit(__doc__)
    with open(sys.argv[2]) as lines:
        KINDS[sys.argv[1]]([json.loads(line) for line in lines], *sys.argv[3:])
