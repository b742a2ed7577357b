"""Makes the figures of the manual, and its tables of the gallery, from runs of the drivers.

usage: make.py BUILD [NAME...]

BUILD is the build folder with the drivers and CGAL's meshes. Names of figures, such as
method_patch, restrict what is drawn. Runs are kept in BUILD/figures, and are made anew if that folder
is removed.
"""

import json
import math
import os
import subprocess
import sys

import charts
from quads import catmull_clark, quads_of_grid, shaken, write
from render import (
    PLAIN,
    Mesh,
    Panel,
    Picture,
    View,
    colours,
    corner_angles,
    distinct_colour,
    distortions,
    read,
    read_values,
    smallest_angles,
    worst_corners,
)

HERE = os.path.dirname(os.path.abspath(__file__))
DOC = os.path.join(HERE, "../../doc/Reference_constrained_optimization")
BENCHMARK = os.path.join(HERE, "../../benchmark/Reference_constrained_optimization")
FIGURES = os.path.join(DOC, "fig")
MANUAL = os.path.join(DOC, "Reference_constrained_optimization.txt")

BUILD = sys.argv[1]
ONLY = sys.argv[2:]
DATA = os.environ.get("RCO_DATA_DIR") or os.path.join(BUILD, "data/meshes")
WORK = os.path.join(BUILD, "figures")


# ---- runs -----------------------------------------------------------------------------------


def data(name):
    return os.path.join(DATA, name + ".off")


def program(name):
    if name == "rco":
        return os.path.join(BUILD, "examples/Reference_constrained_optimization/rco/rco")
    folder = "examples" if name in ("make_quad_mesh", "quad_mesh_optimization") else "benchmark"
    return os.path.join(BUILD, folder, "Reference_constrained_optimization", name)


def run(*command):
    print(" ".join(os.path.basename(c) for c in command), flush=True)
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def folder(*names):
    path = os.path.join(WORK, *names)
    os.makedirs(path, exist_ok=True)
    return path


def rows(name, *command):
    """the rows that a script of the benchmark prints, from the last time if there are some"""
    file = os.path.join(folder(), name + ".json")
    if not os.path.exists(file):
        text = run(sys.executable, *command)
        with open(file, "w") as out:
            out.write(text)
    with open(file) as lines:
        return [json.loads(line) for line in lines]


def runs(name, driver, inputs, *settings):
    """the rows of a driver, which writes its meshes into a folder of this name"""
    return rows(name, os.path.join(BENCHMARK, "run.py"), "--format", "json", "--output", folder(name),
                program(driver), *inputs, "--", *settings)


# ---- what is shown --------------------------------------------------------------------------

# triangle meshes, and where to look at them from: azimuth, elevation, upwards
ANGLE_MESHES = {
    "armadillo": (200, 10, "y"),
    "bull": (30, 20, "y"),
    "camel": (20, 10, "y"),
    "cow": (30, 20, "y"),
    "elephant": (60, 20, "y"),
    "fandisk": (30, 20, "y"),
    "head": (60, 10, "y"),
    "homer": (20, 10, "y"),
    "knot": (20, 30, "y"),
    "lion": (0, 10, "y"),
    "retinal": (30, 20, "y"),
    "triceratops": (30, 20, "y"),
}

# quadrilaterals, and how they come about
QUAD_MESHES = {
    "3torus": (30, 20, "y"),
    "double-torus-example": (30, 70, "y"),
    "knot": (20, 30, "y"),
    "torus_quad": (30, 30, "y"),
}

# source, reference, and where to look at them from
PAIRS = {
    "bear_bear_bis": ("bear", "bear_bis", (0, 10, "y"), (-30, 10, "y")),
    "bull_cow": ("bull", "cow", (210, 20, "y"), (30, 20, "y")),
    "cow_bull": ("cow", "bull", (30, 20, "y"), (210, 20, "y")),
    "eight_twisted": ("eight_fine", "eight_twisted", (20, 50, "y"), (20, 50, "y")),
}

# three scans, three parts
TURN_MESHES = ("armadillo", "bear", "elephant", "couplingdown", "fandisk", "rotor")
CHART_MESHES = ("elephant", "fandisk", "bear", "armadillo")


def optimize_angles():
    return runs("angle", "rco_benchmark", map(data, ANGLE_MESHES), "--check")


def make_quads(name):
    """before, and the reference"""
    mesh = read(data(name))
    if name == "knot":
        quads = quads_of_grid(mesh)
    else:
        quads = mesh
        for _ in range({"3torus": 3, "double-torus-example": 2, "torus_quad": 3}[name]):
            quads = catmull_clark(quads)
    return shaken(quads, 0.6), quads


def optimize_quads():
    pairs = []
    for name in QUAD_MESHES:
        files = [os.path.join(folder("quad_input"), name + e + ".off") for e in ("", "_reference")]
        if not os.path.exists(files[1]):
            for mesh, file in zip(make_quads(name), files):
                write(mesh, file)
        pairs.append(":".join(files))
    return (runs("quad", "quad_benchmark", pairs, "--check", "--leg-length", "1"),
            runs("quad_angle", "quad_benchmark", pairs, "--check", "--energy", "angle"))


def refined(mesh):
    """every triangle in four"""
    points, at, faces = list(mesh.points), {}, []

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in at:
            at[key] = len(points)
            points.append(tuple(0.5 * (x + y) for x, y in zip(points[a], points[b])))
        return at[key]

    for a, b, c in mesh.faces:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        faces += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return Mesh(points, faces)


def twisted(mesh):
    """by a quarter of a turn, stretched and tapered along the third axis"""
    points = []
    for x, y, z in mesh.points:
        scale, angle = 1.3 - 0.8 * z, 0.5 * math.pi * z
        c, s = scale * math.cos(angle), scale * math.sin(angle)
        points.append((c * x - s * y, s * x + c * y, 1.3 * z))
    return Mesh(points, mesh.faces)


# genus 2, made from CGAL's eight, whose vertices keep their numbers
MADE = {
    "eight_fine": lambda: refined(read(data("eight"))),
    "eight_twisted": lambda: twisted(refined(refined(read(data("eight"))))),
}


def map_data(name):
    if name not in MADE:
        return data(name)
    file = os.path.join(folder("made"), name + ".off")
    if not os.path.exists(file):
        write(MADE[name](), file)
    return file


def optimize_maps():
    folders = []
    for pair, (source, reference, _, _) in PAIRS.items():
        path = folder("pairs", pair)
        for file, name in (("Q.off", source), ("R.off", reference)):
            link = os.path.join(path, file)
            if not os.path.exists(link):
                os.symlink(os.path.abspath(map_data(name)), link)
        link = os.path.join(path, "landmarks.txt")
        if not os.path.exists(link):
            os.symlink(os.path.join(HERE, "landmarks", pair + ".txt"), link)
        folders.append(path)
    return runs("map", "compatible_benchmark", folders, "--check", "--start", "landmarks")


# ---- pictures -------------------------------------------------------------------------------

TEXT = 24  # pixels below a panel


def write_picture(picture, name, colors=128):
    file = os.path.join(FIGURES, name + ".png")
    picture.write(file)
    run("pngquant", "--force", "--skip-if-larger", "--speed", "1", "--nofs", "--output", file,
        str(colors), file)
    print(f"{name}.png: {os.path.getsize(file) // 1000} kB", flush=True)


def before_and_after(name, before, after, view, nearby, paint, scale, texts, size=290,
                     edge_width=0.4):
    """all before, a detail of it before and after, all after"""
    gap = 12
    picture = Picture(4 * size + 3 * gap, size + TEXT + 40)
    for i, (mesh, is_near) in enumerate(((before, False), (before, True), (after, True),
                                         (after, False))):
        picture.add(
            Panel(mesh, nearby if is_near else view, colours=paint(mesh), text=texts[i],
                  edge_width=2 * edge_width if is_near else edge_width,
                  frame=None if is_near else nearby, framed=is_near),
            i * (size + gap), TEXT + 40, size, size)
    good, bad, label = scale
    picture.scale(picture.width / 2 - 130, 18, 260, good, bad, label)
    write_picture(picture, name)


def angle_colours(mesh):
    return colours(smallest_angles(mesh), 45, 5)


ANGLE_SCALE = (45, 5, "smallest angle of the face (degrees)")


def corner_colours(mesh):
    return colours(worst_corners(mesh), 0, 80)


CORNER_SCALE = (0, 80, "corner furthest from a right angle (degrees)")
DISTORTION_SCALE = (2, 5, "distortion of the face (2: isometric)")


def row_of(all_rows, key, name):
    return next(r for r in all_rows if r[key] == name)


def angle_picture():
    r = row_of(optimize_angles(), "mesh", "lion")
    before, after = read(data("lion")), read(os.path.join(WORK, "angle/lion.off"))
    view = View(before, *ANGLE_MESHES["lion"])
    right, up = view.right_and_up()
    focus = [f + view.radius * (0.24 * a + 0.34 * b) for f, a, b in zip(view.focus, right, up)]
    figures = [f"{r['theta_min_' + w]:.1f} / {r['theta_mean_' + w]:.1f} degrees" for w in ("in", "out")]
    before_and_after("angle_before_after", before, after, view,
                     view.nearby(focus, 0.22 * view.radius), angle_colours, ANGLE_SCALE,
                     ("before: " + figures[0], "before", "after", "after: " + figures[1]))


def detail_picture():
    """what is finer than the bound on the drift"""
    optimize_angles()
    runs("angle_close", "rco_benchmark", [data("camel")], "--check", "--drift-bound", "0.05")
    meshes = (read(data("camel")), read(os.path.join(WORK, "angle/camel.off")),
              read(os.path.join(WORK, "angle_close/camel.off")))
    view = View(meshes[0], *ANGLE_MESHES["camel"])
    right, up = view.right_and_up()
    focus = [f + view.radius * (0.83 * b - 0.33 * a) for f, a, b in zip(view.focus, right, up)]
    size, gap = 310, 12
    picture = Picture(3 * size + 2 * gap, size + TEXT + 40)
    for i, (mesh, text) in enumerate(zip(meshes, ("before", "default bound: 0.25", "bound: 0.05"))):
        picture.add(
            Panel(mesh, view.nearby(focus, 0.13 * view.radius), colours=angle_colours(mesh), text=text,
                  edge_width=0.5), i * (size + gap), TEXT + 40, size, size)
    good, bad, label = ANGLE_SCALE
    picture.scale(picture.width / 2 - 130, 18, 260, good, bad, label)
    write_picture(picture, "detail_bound")


def quad_picture():
    r = row_of(optimize_quads()[0], "mesh", "3torus")
    before = read(os.path.join(WORK, "quad_input/3torus.off"))
    after = read(os.path.join(WORK, "quad/3torus.off"))
    view = View(after, *QUAD_MESHES["3torus"])
    right, up = view.right_and_up()
    focus = [f + view.radius * (0.2 * b - 0.42 * a) for f, a, b in zip(view.focus, right, up)]
    texts = [f"{int(r['nonconvex_' + w])} not convex, {int(r['folds_' + w])} folds" for w in ("in", "out")]
    before_and_after("quad_before_after", before, after, view,
                     view.nearby(focus, 0.36 * view.radius), corner_colours, CORNER_SCALE,
                     ("before: " + texts[0], "before", "after", "after: " + texts[1]),
                     edge_width=0.5)


def map_picture():
    r = row_of(optimize_maps(), "pair", "bear_bear_bis")
    source = read(data("bear"))
    before = read(os.path.join(WORK, "map/bear_bear_bis_start.off"))
    after = read(os.path.join(WORK, "map/bear_bear_bis_landmarks.off"))
    view = View(after, *PAIRS["bear_bear_bis"][3])
    right, up = view.right_and_up()
    focus = [f + view.radius * (0.05 * a + 0.3 * b) for f, a, b in zip(view.focus, right, up)]
    before_and_after("map_before_after", before, after, view,
                     view.nearby(focus, 0.3 * view.radius),
                     lambda m: colours(distortions(m, source), 2, 5), DISTORTION_SCALE,
                     (f"from landmarks: {r['distortion_mean_in']:.2f}", "before", "after",
                      f"optimized: {r['distortion_mean_out']:.2f}"))


def checker(mesh):
    """a colour for every face, by its place in front of the mesh"""
    low = [min(p[i] for p in mesh.points) for i in range(2)]
    high = [max(p[i] for p in mesh.points) for i in range(2)]
    longest = max(h - l for l, h in zip(low, high))
    result = []
    for f in mesh.faces:
        center = [sum(mesh.points[v][i] for v in f) / len(f) for i in range(2)]
        cells = sum(int(12 * (c - l) / longest) for c, l in zip(center, low))
        s, t = ((c - l) / (h - l) for c, l, h in zip(center, low, high))
        shade = 0.55 if cells % 2 else 1
        result.append(tuple(round(shade * x) for x in (90 + 160 * s, 130 + 90 * t, 250 - 160 * s)))
    return result


def checker_picture():
    optimize_maps()
    size = 330
    names = ("source", "from seven landmarks", "optimized")
    meshes = [refined(refined(read(file))) for file in (
        data("bear"), os.path.join(WORK, "map/bear_bear_bis_start.off"),
        os.path.join(WORK, "map/bear_bear_bis_landmarks.off"))]
    paint = checker(meshes[0])
    picture = Picture(3 * size, size + TEXT)
    for i, (mesh, text) in enumerate(zip(meshes, names)):
        look = View(mesh, *PAIRS["bear_bear_bis"][2 if i == 0 else 3])
        picture.add(Panel(mesh, look, colours=paint, text=text, edge_width=0), i * size, TEXT, size,
                    size)
    write_picture(picture, "compatible_checker")


def edge_width_of(mesh):
    """where edges are a few pixels long, they would hide the colours"""
    return 0.3 if len(mesh.faces) < 18000 else 0


def gallery(name, pairs, paint, scale, columns, size):
    """pairs of (text, before, after, view before, view after), each two panels beside each other"""
    lines = (len(pairs) + columns - 1) // columns
    gap = 16
    width = 2 * size + gap
    picture = Picture(columns * width, lines * (size + TEXT) + 44)
    for i, (text, before, after, first, second) in enumerate(pairs):
        x = width * (i % columns) + gap / 2
        y = picture.height - (size + TEXT) * (i // columns + 1) + TEXT
        for k, (mesh, view) in enumerate(((before, first), (after, second))):
            picture.add(Panel(mesh, view, colours=paint(mesh), edge_width=edge_width_of(mesh)),
                        x + k * size, y, size, size)
        picture.text(x + size, y - 16, text)
    good, bad, label = scale
    picture.scale(picture.width / 2 - 130, 18, 260, good, bad, label)
    write_picture(picture, name)


def angle_gallery():
    pairs = []
    for r in optimize_angles():
        name = r["mesh"]
        before, after = read(data(name)), read(os.path.join(WORK, "angle", name + ".off"))
        view = View(before, *ANGLE_MESHES[name])
        pairs.append((name, before, after, view, view))
    gallery("gallery_angle", pairs, angle_colours, ANGLE_SCALE, 4, 142)


def quad_gallery():
    pairs = []
    optimize_quads()
    for name in QUAD_MESHES:
        before = read(os.path.join(WORK, "quad_input", name + ".off"))
        after = read(os.path.join(WORK, "quad", name + ".off"))
        view = View(after, *QUAD_MESHES[name])
        pairs.append((name, before, after, view, view))
    gallery("gallery_quad", pairs, corner_colours, CORNER_SCALE, 2, 250)


def map_gallery():
    all_rows = optimize_maps()
    size = 250
    picture = Picture(3 * size, len(PAIRS) * (size + TEXT) + 44)
    for i, (pair, (source, reference, first, second)) in enumerate(PAIRS.items()):
        r = row_of(all_rows, "pair", pair)
        y = picture.height - (size + TEXT) * (i + 1) + TEXT
        meshes = (read(map_data(source)),
                  read(os.path.join(WORK, "map", pair + "_start.off")),
                  read(os.path.join(WORK, "map", pair + "_landmarks.off")))
        texts = (source, f"on {reference}: {r['distortion_mean_in']:.2f}",
                 f"optimized: {r['distortion_mean_out']:.2f}")
        for k, (mesh, text) in enumerate(zip(meshes, texts)):
            picture.add(
                Panel(mesh, View(meshes[min(k, 1)], *(second if k else first)), text=text,
                      colours=colours(distortions(mesh, meshes[0]), 2, 5),
                      edge_width=edge_width_of(mesh)),
                k * size, y, size, size)
    good, bad, label = DISTORTION_SCALE
    picture.scale(picture.width / 2 - 130, 18, 260, good, bad, label)
    write_picture(picture, "gallery_map")


# ---- the method -----------------------------------------------------------------------------


def face_at(mesh, view, x, y):
    """the face in sight at a place of the panel, from -1 to 1"""
    best = None
    flat = [view.project(p) for p in mesh.points]
    for number, f in enumerate(mesh.faces):
        corners = [flat[v] for v in f]
        signs = [
            (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
            for a, b in zip(corners, corners[1:] + corners[:1])
        ]
        if all(s > 0 for s in signs):
            height = sum(view.height(mesh.points[v]) for v in f) / len(f)
            if best is None or height > best[0]:
                best = (height, number)
    if best is None:
        raise RuntimeError("there is no face in sight")
    return best[1]


def stages(name, view, place, patch_size, partition_size):
    path = folder("stages", name)
    mesh = read(data(name))
    run(program("method_pictures"), data(name), path, str(face_at(mesh, view(mesh), *place)),
        str(patch_size), str(partition_size))
    return path


# not in the patch, in the two rings along its boundary, done with, the seed
REGIONS = [PLAIN, (250, 200, 110), (120, 185, 235), (215, 30, 40)]


def stage_meshes(path):
    return [read(os.path.join(path, n + ".off")) for n in
            ("patch", "patch_flat", "patch_optimized", "patch_mapped")]


def flat_view(mesh):
    return View(mesh, 0, 90, "z", margin=1.08)


def method_pictures():
    name, place, patch_size = "lion", (-0.05, 0.42), 548
    look = ANGLE_MESHES[name]
    path = stages(name, lambda m: View(m, *look), place, patch_size, 4000)
    mesh = read(data(name))
    regions = [REGIONS[int(v)] for v in read_values(os.path.join(path, "regions.txt"))]
    patch_regions = [REGIONS[int(v)] for v in read_values(os.path.join(path, "patch_regions.txt"))]
    before, flat, optimized, mapped = stage_meshes(path)
    view, nearby = View(mesh, *look), View(before, *look, margin=1.1)
    size, gap = 330, 12

    picture = Picture(3 * size + 2 * gap, size + TEXT)
    picture.add(Panel(mesh, view, colours=regions, text="the mesh, and a patch of it", edge_width=0.4,
                      frame=nearby), 0, TEXT, size, size)
    picture.add(Panel(mesh, nearby, colours=regions, edge_width=0.7, framed=True,
                      text="seed, done with, the two rings along the boundary"),
                size + gap, TEXT, size, size)
    picture.add(Panel(flat, flat_view(flat), colours=patch_regions, text="flattened", flat=True,
                      edge_width=0.7), 2 * (size + gap), TEXT, size, size)
    write_picture(picture, "method_patch")

    size = 270
    picture = Picture(4 * size + 3 * gap, size + TEXT + 40)
    for i, (m, v, text) in enumerate((
        (flat, flat_view(flat), "flattened"),
        (optimized, flat_view(flat), "optimized in the plane"),
        (before, nearby, "on the surface, before"),
        (mapped, nearby, "on the surface, after"),
    )):
        picture.add(Panel(m, v, colours=angle_colours(m), text=text, flat=i < 2, edge_width=0.7),
                    i * (size + gap), TEXT + 40, size, size)
    good, bad, label = ANGLE_SCALE
    picture.scale(picture.width / 2 - 130, 18, 260, good, bad, label)
    write_picture(picture, "method_plane")


def partition_picture():
    name, look = "armadillo", ANGLE_MESHES["armadillo"]
    path = stages(name, lambda m: View(m, *look), (0, 0), 400, 6500)
    mesh = read(data(name))
    cells = [distinct_colour(int(v)) for v in read_values(os.path.join(path, "partition.txt"))]
    size = 330
    picture = Picture(2 * size, size)
    for i, azimuth in enumerate((look[0], look[0] + 180)):
        picture.add(Panel(mesh, View(mesh, azimuth, *look[1:]), colours=cells, edge_width=0),
                    i * size, 0, size, size)
    write_picture(picture, "method_partition")


# ---- charts ---------------------------------------------------------------------------------


def figure(name):
    return os.path.join(FIGURES, name + ".svg")


def trade_charts():
    meshes = list(map(data, CHART_MESHES))
    charts.energy(runs("energy", "rco_benchmark", meshes, "--history", "--method", "ours,plain",
                       "--finishing", "0", "--drift-bound", "inf"), figure("energy"))
    charts.bound(runs("trade_drift_bound", "rco_benchmark", meshes, "--drift-bound",
                      "0.1,0.15,0.25,0.5,1,inf"), figure("trade_drift_bound"))
    charts.exponent(runs("trade_exponent", "rco_benchmark", meshes, "--exponent", "1,2,5",
                         "--finishing", "1,0"), figure("trade_exponent"))


def turn_chart():
    bounds = ("0.05e", "0.1e", "0.15e", "0.25e", "0.5e", "default")
    own = []
    for mesh in TURN_MESHES:
        for bound in bounds:
            for seed in "0123":
                file = os.path.join(folder("turn"), f"{mesh}-{bound}-{seed}.json")
                if not os.path.exists(file):
                    limit = () if bound == "default" else ("--drift-bound", bound)
                    text = run(program("rco"), "angle", data(mesh), "--json", "--random-seed", seed, *limit)
                    with open(file, "w") as out:
                        out.write(text)
                with open(file) as result:
                    own.append({"mesh": mesh, "drift-bound": bound, **json.load(result)})
    charts.turn(own, figure("trade_turn"))


def peer_charts():
    charts.peers(rows("peers", os.path.join(BENCHMARK, "quality/side_by_side.py"), "--format", "json",
                      program("side_by_side"), *map(data, CHART_MESHES)),
                 figure("peers_angles"), figure("peers_drift"))


def all_angles(mesh):
    return [angle for f in mesh.faces for angle in corner_angles(mesh, f)]


def angle_histograms():
    optimize_angles()
    for name in ("armadillo", "fandisk"):
        after = read(os.path.join(WORK, "angle", name + ".off"))
        charts.histogram("Angles of " + name, "angle (degrees)", all_angles(read(data(name))),
                         all_angles(after), range(0, 181, 2), 60, "°", figure("angles_" + name))


def relative_lengths(mesh):
    edges = {frozenset((f[i - 1], f[i])) for f in mesh.faces for i in range(len(f))}
    lengths = [math.dist(*(mesh.points[v] for v in e)) for e in edges]
    return [length * len(lengths) / sum(lengths) for length in lengths]


def quad_histograms():
    files = [os.path.join(folder("quad_histograms"), name) for name in ("before.obj", "after.obj")]
    run(program("make_quad_mesh"), data("nefertiti"), files[0])
    run(program("quad_mesh_optimization"), data("nefertiti"), files[1], "--energy", "angle")
    before, after = map(read, files)
    charts.histogram("Corner angles", "angle (degrees)", all_angles(before), all_angles(after),
                     range(0, 181, 2), 90, "°", figure("quad_angles"))
    charts.histogram("Edge lengths", "length over mean length", relative_lengths(before),
                     relative_lengths(after), [i / 20 for i in range(52)], 1, "", figure("quad_edges"))


# ---- tables ---------------------------------------------------------------------------------


def table(name, head, lines):
    """what is between the two marks of this name in the manual becomes this table"""
    with open(MANUAL) as text:
        manual = text.read()
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    if begin not in manual or end not in manual:
        raise RuntimeError(f"the manual has no place for the table {name}")
    rule = "|" + "---|" * len(head)
    body = "\n".join("| " + " | ".join(line) + " |" for line in lines)
    before, after = manual.split(begin)[0], manual.split(end)[1]
    with open(MANUAL, "w") as out:
        out.write(f"{before}{begin}\n| {' | '.join(head)} |\n{rule}\n{body}\n\n{end}{after}")


def drift(r, end=""):
    return f"{max(r['drift_mesh_to_reference' + end], r['drift_reference_to_mesh' + end]):.2f}"


def count(r, what):
    return f"{int(r[what + '_in'])} → {int(r[what + '_out'])}"


def tables():
    lines = []
    for r in optimize_angles():
        lines.append([
            r["mesh"], f"{int(r['vertices'])} / {int(r['faces'])}",
            f"{r['theta_min_in']:.1f} / {r['theta_mean_in']:.1f}",
            f"{r['theta_min_out']:.1f} / {r['theta_mean_out']:.1f}",
            drift(r), count(r, "flips"), count(r, "folds"),
            f"{r['n_in']:.0f} / {int(r['n_out'])}", f"{r['time_s']:.1f}"])
    table("gallery of angles",
          ["Mesh", "V / F", "θ before (min / mean)", "θ after", "drift", "flips", "folds",
           "N_in / N_out", "time (s)"], lines)

    lines = []
    for kind, all_rows in zip(("edges, l = 1", "angles"), optimize_quads()):
        for r in all_rows:
            lines.append([
                r["mesh"], f"{int(r['vertices'])} / {int(r['faces'])}", kind,
                *(f"{r['edge_std_' + w]:.2f}" for w in ("in", "out")),
                *(f"{r['angle_min_' + w]:.0f} / {r['angle_max_' + w]:.0f} / {r['angle_std_' + w]:.1f}"
                  for w in ("in", "out")),
                count(r, "nonconvex"), count(r, "folds"), drift(r, "_out"),
                f"{r['n_in']:.0f} / {int(r['n_out'])}", f"{r['time_s']:.1f}"])
    lines.sort(key=lambda line: line[0])
    table("gallery of quads",
          ["Mesh", "V / F", "Energy", "edge deviation before", "after",
           "corner angles before (min / max / std)", "after", "not convex", "folds", "drift",
           "N_in / N_out", "time (s)"], lines)

    lines = []
    for r in optimize_maps():
        source, reference = PAIRS[r["pair"]][:2]
        lines.append([
            f"{source} on {reference}", f"{int(r['vertices'])}",
            f"{r['distortion_mean_in']:.2f}", f"{r['distortion_mean_out']:.2f}",
            f"{r['distortion_median']:.2f} / {r['distortion_p99']:.2f} / {r['distortion_max']:.1f}",
            count(r, "flips"), count(r, "folds"),
            f"{r['drift_mesh_to_reference_out']:.2f} / {r['drift_reference_to_mesh_out']:.2f}",
            f"{r['n_in']:.0f} / {int(r['n_out'])}", f"{r['time_s']:.1f}"])
    table("gallery of maps",
          ["Map", "V", "mean distortion before", "after", "after: median / 99 % / maximum", "flips",
           "folds", "drift / coverage", "N_in / N_out", "time (s)"], lines)


TASKS = {
    "angle_before_after": angle_picture,
    "detail_bound": detail_picture,
    "quad_before_after": quad_picture,
    "map_before_after": map_picture,
    "compatible_checker": checker_picture,
    "method_patch": method_pictures,
    "method_partition": partition_picture,
    "gallery_angle": angle_gallery,
    "gallery_quad": quad_gallery,
    "gallery_map": map_gallery,
    "angle_histograms": angle_histograms,
    "quad_histograms": quad_histograms,
    "trade_charts": trade_charts,
    "turn_chart": turn_chart,
    "peer_charts": peer_charts,
    "tables": tables,
}

if __name__ == "__main__":
    unknown = [name for name in ONLY if name not in TASKS]
    if unknown:
        sys.exit(f"make.py: there is no {unknown[0]}, but " + ", ".join(TASKS))
    for task in ONLY or TASKS:
        TASKS[task]()
