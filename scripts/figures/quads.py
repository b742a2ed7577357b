"""Quadrilateral meshes to begin with, made of CGAL's triangles and polygons."""

import heapq
import math
import random

from render import Mesh, corner_angles


def catmull_clark(mesh):
    """one step of the subdivision of a closed mesh"""

    def mean(points):
        points = list(points)
        return tuple(sum(p[i] for p in points) / len(points) for i in range(3))

    points = mesh.points
    centers = [mean(points[v] for v in f) for f in mesh.faces]
    face_of = {(f[i - 1], f[i]): n for n, f in enumerate(mesh.faces) for i in range(len(f))}
    middles, at = [], {}
    faces_at = [[] for _ in points]
    for n, f in enumerate(mesh.faces):
        for i in range(len(f)):
            a, b = f[i - 1], f[i]
            faces_at[b].append(n)
            if (b, a) not in at:
                at[a, b] = len(points) + len(centers) + len(middles)
                middles.append(mean((points[a], points[b], centers[n], centers[face_of[b, a]])))
            else:
                at[a, b] = at[b, a]
    edge_sum, valence = [(0.0, 0.0, 0.0)] * len(points), [0] * len(points)
    for a, b in at:
        edge_sum[a] = tuple(x + 0.5 * (y + z) for x, y, z in zip(edge_sum[a], points[a], points[b]))
        valence[a] += 1
    moved = []
    for v, p in enumerate(points):
        n = valence[v]
        f = mean(centers[g] for g in faces_at[v])
        moved.append(tuple((f[i] + 2 * edge_sum[v][i] / n + (n - 3) * p[i]) / n for i in range(3)))
    faces = []
    for n, f in enumerate(mesh.faces):
        for i in range(len(f)):
            a, b, c = f[i - 1], f[i], f[(i + 1) % len(f)]
            faces.append((at[a, b], b, at[b, c], len(points) + n))
    return Mesh(moved + centers + middles, faces)


def shaken(mesh, part, seed=1):
    """every vertex moves into one of the triangles around it, by up to `part` of the way across

    Quadrilaterals are split by the shorter diagonal, as a reference is.
    """
    triangles = [[] for _ in mesh.points]
    for f in mesh.faces:
        p = [mesh.points[v] for v in f]
        k = 0 if len(f) == 3 or math.dist(p[0], p[2]) <= math.dist(p[1], p[3]) else 1
        halves = [f] if len(f) == 3 else [(f[k], f[k + 1], f[k + 2]),
                                          (f[k], f[k + 2], f[(k + 3) % 4])]
        for t in halves:
            for i in range(3):
                triangles[t[i]].append((t[i - 1], t[i - 2]))
    draw = random.Random(seed)
    moved = []
    for p, around in zip(mesh.points, triangles):
        b, c = (mesh.points[v] for v in around[draw.randrange(len(around))])
        s, t = draw.random(), draw.random()
        if s + t > 1:
            s, t = 1 - s, 1 - t
        s, t = part * s, part * t
        moved.append(tuple(x + s * (y - x) + t * (z - x) for x, y, z in zip(p, b, c)))
    return Mesh(moved, mesh.faces)


def write(mesh, file):
    with open(file, "w") as out:
        out.write(f"OFF\n{len(mesh.points)} {len(mesh.faces)} 0\n")
        for p in mesh.points:
            out.write("%r %r %r\n" % tuple(p))
        for f in mesh.faces:
            out.write(" ".join(map(str, (len(f),) + tuple(f))) + "\n")


def quads_of_grid(mesh):
    """The mesh without the diagonals.

    Grown from one quadrilateral: a triangle next to what is known has a side, so that only two of
    its edges may be the diagonal. Those that are the clearest come first.
    """
    # of each directed edge its face and the third corner of that
    half = {
        (f[i], f[(i + 1) % 3]): (number, f[(i + 2) % 3])
        for number, f in enumerate(mesh.faces)
        for i in range(3)
    }

    def quad(a, b):
        return (half[a, b][1], a, half[b, a][1], b)

    def error(a, b):
        return sum(abs(angle - 90) for angle in corner_angles(mesh, quad(a, b)))

    sides = [set() for _ in mesh.faces]  # edges that are known to be no diagonals
    is_done = [False] * len(mesh.faces)
    faces, queue = [], []

    def choices(t):
        f = mesh.faces[t]
        edges = [(f[i], f[(i + 1) % 3]) for i in range(3)]
        return sorted(
            (error(*e), e) for e in edges
            if e not in sides[t] and e[::-1] in half and not is_done[half[e[::-1]][0]]
        )

    def push(t):
        found = choices(t)
        if not found:
            raise RuntimeError("the triangles are no grid")
        clearness = found[1][0] - found[0][0] if len(found) > 1 else float("inf")
        heapq.heappush(queue, (-clearness, t, len(sides[t])))

    def remove(a, b):
        pair = half[a, b][0], half[b, a][0]
        for t in pair:
            is_done[t] = True
        faces.append(quad(a, b))
        for i in range(4):
            back = (faces[-1][(i + 1) % 4], faces[-1][i])
            t = half[back][0] if back in half else None
            if t is not None and not is_done[t]:
                sides[t].add(back)
                push(t)

    remove(*min(choices(t)[0] for t in range(len(mesh.faces)))[1])
    while queue:
        _, t, known = heapq.heappop(queue)
        if not is_done[t] and known == len(sides[t]):
            remove(*choices(t)[0][1])
    if not all(is_done):
        raise RuntimeError("the triangles are no grid")
    return Mesh(mesh.points, faces)
