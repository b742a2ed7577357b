"""Pictures of meshes, made off-screen with VTK (Debian: python3-vtk9).

A picture is a list of panels. A panel shows a mesh, or a square of it from nearby, in a parallel
projection, so that two panels with the same view can be compared edge by edge.
"""

import math
import os

from vtkmodules.vtkCommonCore import vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkImagingCore import vtkImageShrink3D
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkActor2D,
    vtkLight,
    vtkPolyDataMapper,
    vtkPolyDataMapper2D,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextActor,
    vtkWindowToImageFilter,
)
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (texts)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (what renders)

SCALE = 2  # rendered so much larger, then averaged


# ---- meshes ---------------------------------------------------------------------------------


class Mesh:
    def __init__(self, points, faces):
        self.points = points
        self.faces = faces

    def center_and_radius(self):
        low = [min(p[i] for p in self.points) for i in range(3)]
        high = [max(p[i] for p in self.points) for i in range(3)]
        center = [0.5 * (a + b) for a, b in zip(low, high)]
        return center, max(math.dist(p, center) for p in self.points)

    def mean_edge(self):
        lengths = [
            math.dist(self.points[f[i - 1]], self.points[f[i]])
            for f in self.faces
            for i in range(len(f))
        ]
        return sum(lengths) / len(lengths)


def read(file):
    if file.endswith(".obj"):
        return read_obj(file)
    numbers = []
    with open(file) as lines:
        for line in lines:
            numbers.extend(line.split("#")[0].split())
    if numbers.pop(0) != "OFF":
        raise RuntimeError(file + " is not a plain OFF file")
    v, f = int(numbers[0]), int(numbers[1])
    points = [tuple(map(float, numbers[3 + 3 * i : 6 + 3 * i])) for i in range(v)]
    faces, at = [], 3 + 3 * v
    for _ in range(f):
        n = int(numbers[at])
        faces.append(tuple(map(int, numbers[at + 1 : at + 1 + n])))
        at += 1 + n
    return Mesh(points, faces)


def read_obj(file):
    points, faces = [], []
    with open(file) as lines:
        for line in lines:
            words = line.split()
            if words and words[0] == "v":
                points.append(tuple(map(float, words[1:4])))
            elif words and words[0] == "f":
                faces.append(tuple(int(w.split("/")[0]) - 1 for w in words[1:]))
    return Mesh(points, faces)


def read_values(file):
    with open(file) as lines:
        return [float(line) for line in lines]


def corner_angles(mesh, face):
    angles = []
    for i in range(len(face)):
        p = mesh.points[face[i]]
        a = [x - y for x, y in zip(mesh.points[face[i - 1]], p)]
        b = [x - y for x, y in zip(mesh.points[face[(i + 1) % len(face)]], p)]
        n = math.hypot(*a) * math.hypot(*b)
        cosine = sum(x * y for x, y in zip(a, b)) / n if n > 0 else 1
        angles.append(math.degrees(math.acos(max(-1, min(1, cosine)))))
    return angles


def smallest_angles(mesh):
    return [min(corner_angles(mesh, f)) for f in mesh.faces]


def worst_corners(mesh):
    """of each face the largest difference to the angle of a regular one"""
    return [max(abs(a - 180 + 360 / len(f)) for a in corner_angles(mesh, f)) for f in mesh.faces]


def singular_values(mesh, source, face):
    """the two stretches of the map of a triangle"""

    def shape(points):
        a = [x - y for x, y in zip(points[face[1]], points[face[0]])]
        b = [x - y for x, y in zip(points[face[2]], points[face[0]])]
        x = math.hypot(*a)
        along = sum(s * t for s, t in zip(a, b)) / x
        return x, along, math.sqrt(max(0, sum(s * s for s in b) - along * along))

    x, y, z = shape(source.points)
    u, v, w = shape(mesh.points)
    # J = [[u, v], [0, w]] [[x, y], [0, z]]^-1
    j00, j01, j11 = u / x, (v - u * y / x) / z, w / z
    square, area = j00 * j00 + j01 * j01 + j11 * j11, j00 * j11
    root = math.sqrt(max(0, square * square / 4 - area * area))
    return math.sqrt(square / 2 + root), math.sqrt(max(0, square / 2 - root))


def area(mesh):
    total = 0
    for f in mesh.faces:
        for i in range(1, len(f) - 1):
            a = [x - y for x, y in zip(mesh.points[f[i]], mesh.points[f[0]])]
            b = [x - y for x, y in zip(mesh.points[f[i + 1]], mesh.points[f[0]])]
            cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
            total += 0.5 * math.hypot(*cross)
    return total


def distortions(mesh, source):
    """half the symmetric Dirichlet density of the map from the source, scaled to the same area"""
    square = area(mesh) / area(source)
    result = []
    for f in mesh.faces:
        s, t = singular_values(mesh, source, f)
        s2, t2 = s * s / square, t * t / square
        result.append(0.5 * (s2 + t2 + 1 / s2 + 1 / t2) if t > 0 else math.inf)
    return result


# ---- colours --------------------------------------------------------------------------------

# from good to bad; the last one is for what is beyond the scale
SCALE_COLOURS = [(232, 240, 247), (253, 231, 170), (248, 160, 80), (206, 52, 42), (110, 8, 30)]
PLAIN = (214, 224, 234)


def scale_colour(share):
    share = max(0.0, min(1.0, share)) * (len(SCALE_COLOURS) - 1)
    i = min(int(share), len(SCALE_COLOURS) - 2)
    t = share - i
    return tuple(round((1 - t) * a + t * b) for a, b in zip(SCALE_COLOURS[i], SCALE_COLOURS[i + 1]))


def colours(values, good, bad):
    return [scale_colour((v - good) / (bad - good)) for v in values]


def distinct_colour(i):
    """colours that differ from those of the numbers around, pale enough for edges to be seen"""
    import colorsys

    r, g, b = colorsys.hsv_to_rgb((0.11 + i * 0.61803) % 1, 0.5, 1 - 0.16 * (i % 3))
    return (round(255 * r), round(255 * g), round(255 * b))


# ---- views ----------------------------------------------------------------------------------


class View:
    """where one looks from, and what square is in sight"""

    def __init__(self, mesh, azimuth=30, elevation=20, up="y", aspect=1, margin=1.04):
        axes = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}[up]  # forward, right, up
        a, e = math.radians(azimuth), math.radians(elevation)
        direction = [0.0, 0.0, 0.0]
        direction[axes[0]] = math.cos(e) * math.cos(a)
        direction[axes[1]] = math.cos(e) * math.sin(a)
        direction[axes[2]] = math.sin(e)
        self.direction = direction
        self.up = [0.0, 0.0, 0.0]
        self.up[axes[2]] = 1.0
        self.focus, whole = mesh.center_and_radius()
        self.distance = 4 * whole
        self.radius = 1
        # as near as may be, all being in sight
        flat = [self.project(p) for p in mesh.points]
        low = [min(p[i] for p in flat) for i in range(2)]
        high = [max(p[i] for p in flat) for i in range(2)]
        right, above = self.right_and_up()
        self.focus = [
            c + 0.5 * (low[0] + high[0]) * r + 0.5 * (low[1] + high[1]) * a
            for c, r, a in zip(self.focus, right, above)
        ]
        self.radius = margin * 0.5 * max((high[0] - low[0]) / aspect, high[1] - low[1])

    def nearby(self, focus, radius):
        other = View.__new__(View)
        other.__dict__.update(self.__dict__)
        other.focus, other.radius = focus, radius
        return other

    def right_and_up(self):
        d, u = self.direction, self.up
        right = [u[1] * d[2] - u[2] * d[1], u[2] * d[0] - u[0] * d[2], u[0] * d[1] - u[1] * d[0]]
        n = math.hypot(*right)
        right = [x / n for x in right]
        up = [
            d[1] * right[2] - d[2] * right[1],
            d[2] * right[0] - d[0] * right[2],
            d[0] * right[1] - d[1] * right[0],
        ]
        return right, up

    def project(self, point):
        """in halves of the height of the panel, from its middle"""
        right, up = self.right_and_up()
        d = [a - b for a, b in zip(point, self.focus)]
        return (
            sum(a * b for a, b in zip(d, right)) / self.radius,
            sum(a * b for a, b in zip(d, up)) / self.radius,
        )

    def height(self, point):
        """how near to the eye a point is"""
        return sum(a * b for a, b in zip(point, self.direction))


# ---- pictures -------------------------------------------------------------------------------


class Panel:
    def __init__(
        self,
        mesh,
        view,
        colours=None,
        text="",
        edge=(40, 50, 60),
        edge_width=0.6,
        frame=None,  # a view from nearby, whose square is drawn
        framed=False,  # the panel has the colour of such a square around it
        flat=False,  # no light and shade
        lines=(),  # (list of points, colour, width)
        points=(),  # (point, colour, size)
        smooth=False,
    ):
        self.__dict__.update(locals())


def polydata(mesh, face_colours):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for p in mesh.points:
        points.InsertNextPoint(p)
    cells = vtkCellArray()
    for f in mesh.faces:
        cells.InsertNextCell(len(f))
        for v in f:
            cells.InsertCellPoint(v)
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    array = vtkUnsignedCharArray()
    array.SetNumberOfComponents(3)
    array.SetName("colours")
    for i in range(len(mesh.faces)):
        array.InsertNextTuple3(*(face_colours[i] if face_colours else PLAIN))
    data.GetCellData().SetScalars(array)
    return data


def line_data(lists):
    points, cells = vtkPoints(), vtkCellArray()
    for line in lists:
        cells.InsertNextCell(len(line))
        for p in line:
            cells.InsertCellPoint(points.InsertNextPoint(*(list(p) + [0, 0])[:3]))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    return data


def unit(colour):
    return tuple(c / 255 for c in colour)


FRAME = (20, 110, 60)


class Picture:
    def __init__(self, width, height, background=(255, 255, 255)):
        self.width, self.height = width, height
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(SCALE * width, SCALE * height)
        # texts and boxes are above all panels
        self.window.SetNumberOfLayers(2)
        base, self.base = vtkRenderer(), vtkRenderer()
        base.SetBackground(unit(background))
        self.window.AddRenderer(base)
        self.base.SetLayer(1)
        self.window.AddRenderer(self.base)
        self.background = background

    def text(self, x, y, text, size=13, bold=False, align="center", colour=(30, 30, 30)):
        """at (x, y) in pixels from the lower left"""
        actor = vtkTextActor()
        actor.SetInput(text)
        actor.SetPosition(SCALE * x, SCALE * y)
        p = actor.GetTextProperty()
        p.SetFontSize(SCALE * size)
        p.SetColor(unit(colour))
        p.SetBold(bold)
        {"center": p.SetJustificationToCentered, "left": p.SetJustificationToLeft}[align]()
        self.base.AddActor2D(actor)

    def box(self, x, y, width, height, colour):
        """a filled rectangle, in pixels from the lower left"""
        self._outline(self.base, [(x, y), (x + width, y), (x + width, y + height), (x, y + height)],
                      colour, 1, filled=True)

    def _outline(self, renderer, corners, colour, width, filled=False):
        data = line_data([[(SCALE * x, SCALE * y) for x, y in corners + corners[:1]]])
        if filled:
            cells = vtkCellArray()
            cells.InsertNextCell(len(corners))
            for i in range(len(corners)):
                cells.InsertCellPoint(i)
            data.SetPolys(cells)
        mapper = vtkPolyDataMapper2D()
        mapper.SetInputData(data)
        actor = vtkActor2D()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(unit(colour))
        actor.GetProperty().SetLineWidth(SCALE * width)
        renderer.AddActor2D(actor)

    def scale(self, x, y, width, good, bad, label, steps=5):
        """the colour scale with its figures"""
        n = 60
        for i in range(n):
            self.box(x + width * i / n, y, width / n + 0.6, 10, scale_colour((i + 0.5) / n))
        for i in range(steps):
            value = good + (bad - good) * i / (steps - 1)
            self.text(x + width * i / (steps - 1), y - 15, f"{value:g}", 11)
        self.text(x + width / 2, y + 14, label, 11)

    def add(self, panel, x, y, width, height):
        """the panel's picture in the rectangle, in pixels from the lower left"""
        renderer = vtkRenderer()
        renderer.SetViewport(x / self.width, y / self.height, (x + width) / self.width,
                             (y + height) / self.height)
        renderer.SetBackground(unit(self.background))
        self.window.AddRenderer(renderer)

        data = polydata(panel.mesh, panel.colours)
        mapper = vtkPolyDataMapper()
        if panel.smooth:
            normals = vtkPolyDataNormals()
            normals.SetInputData(data)
            normals.SplittingOff()
            mapper.SetInputConnection(normals.GetOutputPort())
        else:
            mapper.SetInputData(data)
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        actor = vtkActor()
        actor.SetMapper(mapper)
        p = actor.GetProperty()
        if not panel.smooth:
            p.SetInterpolationToFlat()
        if panel.flat:
            p.LightingOff()
        else:
            p.SetAmbient(0.55)
            p.SetDiffuse(0.5)
            p.SetSpecular(0.0)
        if panel.edge_width > 0:
            p.EdgeVisibilityOn()
            p.SetEdgeColor(unit(panel.edge))
            p.SetLineWidth(SCALE * panel.edge_width)
        renderer.AddActor(actor)

        view = panel.view
        for line, colour, line_width in panel.lines:
            # lifted towards the eye, so that it is not hidden by what it lies on
            lift = 0.01 * view.radius
            lifted = [[a + lift * b for a, b in zip(q, view.direction)] for q in line]
            m = vtkPolyDataMapper()
            m.SetInputData(line_data([lifted]))
            a = vtkActor()
            a.SetMapper(m)
            a.GetProperty().SetColor(unit(colour))
            a.GetProperty().SetLineWidth(SCALE * line_width)
            a.GetProperty().LightingOff()
            renderer.AddActor(a)

        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(view.focus)
        camera.SetPosition([f + view.distance * d for f, d in zip(view.focus, view.direction)])
        camera.SetViewUp(view.up if abs(view.direction[2]) < 0.999 or view.up[2] == 0 else (0, 1, 0))
        camera.SetParallelScale(view.radius)
        camera.SetClippingRange(0.01 * view.distance, 3 * view.distance)
        renderer.AutomaticLightCreationOff()
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(-0.5, 0.6, 1)
        renderer.AddLight(light)

        if panel.frame is not None:
            cx, cy = view.project(panel.frame.focus)
            r = panel.frame.radius / view.radius
            mx, my, h = 0.5 * width, 0.5 * height, 0.5 * height
            corners = [(mx + h * (cx + i * r), my + h * (cy + j * r))
                       for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            self._outline(renderer, corners, FRAME, 1.6)
        if panel.framed:
            self._outline(renderer, [(1, 1), (width - 1, 1), (width - 1, height - 1), (1, height - 1)],
                          FRAME, 2)
        if panel.text:
            self.text(x + width / 2, y - 18, panel.text)

    def write(self, file):
        self.window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.Update()
        shrink = vtkImageShrink3D()
        shrink.SetInputConnection(grab.GetOutputPort())
        shrink.SetShrinkFactors(SCALE, SCALE, 1)
        shrink.SetMean(1)
        writer = vtkPNGWriter()
        writer.SetInputConnection(shrink.GetOutputPort())
        writer.SetFileName(file)
        writer.Write()
        self.window.Finalize()
        if not os.path.exists(file):
            raise RuntimeError(file + " was not written")
