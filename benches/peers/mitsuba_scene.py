"""qrt's scene files as Mitsuba 3 reads scenes: what is needed for matte surfaces and lamps.

Conventions of qrt that Mitsuba has to be told: all faces are flat; a quad v0 v1 v2 v3 that is not
planar is the triangles v0 v1 v2 and v0 v2 v3; a lamp shines from the side of (v1 - v0) x (v2 - v0)
alone and, unless it has an albedo, reflects nothing; every other surface reflects on both sides; the
field of view is vertical; depth counts the rays of a path, which is Mitsuba's `max_depth`.

A lamp that is a parallelogram becomes a `rectangle`, which Mitsuba samples directly; all triangles of
one material become one mesh.
"""

import math
import pathlib

import numpy
import yaml

FIELDS = {
    "camera": {"perspective"},
    "perspective": {"eye", "target", "up", "vfov"},
    "film": {"width", "height"},
    "lambertian": {"albedo"},
    "emitter": {"radiance", "albedo"},
    "quad": {"vertices", "material"},
    "triangle": {"vertices", "material"},
    "mesh": {"obj", "material", "scale", "rotate", "translate"},
}


class Unsupported(Exception):
    """The scene says something that is not translated."""


class Scene:
    """A scene file: its `width`, `height` and `depth`, and what it shows."""

    def __init__(self, path):
        path = pathlib.Path(path)
        tree = yaml.safe_load(path.read_text())
        self.camera = read(read(tree["camera"], "camera")["perspective"], "perspective")
        film = read(tree["film"], "film")
        self.width, self.height = film["width"], film["height"]
        self.depth = len(tree["sampling"]["depths"])
        self.materials = dict(map(material, tree["materials"].items()))
        # By material, so that there are few shapes.
        self.triangles = {name: [] for name in self.materials}
        self.lamps = []
        for geometry in tree["geometry"]:
            self.add(geometry, path.parent)

    def add(self, geometry, folder):
        [(kind, geometry)] = geometry.items()
        geometry = read(geometry, kind)
        name = geometry["material"]
        emits = self.materials[name][0] == "emitter"
        if kind == "mesh":
            self.triangles[name].extend(mesh(geometry, folder))
            return
        vertices = numpy.array(geometry["vertices"], dtype=float)
        if kind == "quad" and emits and is_parallelogram(vertices):
            self.lamps.append((name, vertices))
            return
        corners = [[0, 1, 2], [0, 2, 3]] if kind == "quad" else [[0, 1, 2]]
        self.triangles[name].extend(vertices[corner] for corner in corners)

    def key(self):
        """Everything that a picture depends on, as bytes."""
        parts = [self.camera, self.width, self.height, self.depth, self.materials]
        triangles = {name: numpy.array(all).tolist() for name, all in self.triangles.items()}
        lamps = [(name, vertices.tolist()) for name, vertices in self.lamps]
        return repr([*parts, triangles, lamps]).encode()

    def load(self, mi, folder):
        """The scene in Mitsuba `mi`, whose meshes are passed through files in `folder`."""
        scene = {"type": "scene"}
        for name, triangles in self.triangles.items():
            if triangles:
                file = pathlib.Path(folder) / f"{len(scene)}.ply"
                write_ply(file, triangles)
                shape = {"type": "ply", "filename": str(file), "face_normals": True}
                scene[f"shape{len(scene)}"] = shape | self.surface(name)
        for name, [v0, v1, _, v3] in self.lamps:
            # The square [-1, 1]^2 whose normal is z.
            x, y = (v1 - v0) / 2, (v3 - v0) / 2
            z = numpy.cross(x, y)
            columns = [x, y, z / numpy.linalg.norm(z), v0 + x + y]
            matrix = numpy.vstack([numpy.array(columns).T, [0, 0, 0, 1]])
            shape = {"type": "rectangle", "to_world": mi.ScalarTransform4f(matrix)}
            scene[f"shape{len(scene)}"] = shape | self.surface(name)
        return mi.load_dict(scene)

    def sensor(self, mi, sampler):
        """The camera in Mitsuba `mi`, with a film of pixels that each hold the mean of a square."""
        camera = self.camera
        up = camera.get("up", [0, 1, 0])
        return mi.load_dict(
            {
                "type": "perspective",
                "fov": camera["vfov"],
                "fov_axis": "y",
                "near_clip": 1e-3,
                "far_clip": 1e6,
                "to_world": mi.ScalarTransform4f().look_at(camera["eye"], camera["target"], up),
                "sampler": sampler,
                "film": {
                    "type": "hdrfilm",
                    "width": self.width,
                    "height": self.height,
                    "pixel_format": "rgb",
                    "component_format": "float32",
                    "rfilter": {"type": "box"},
                },
            }
        )

    def surface(self, name):
        """What Mitsuba attaches to shapes of a material."""
        kind, values = self.materials[name]
        albedo = {"type": "rgb", "value": values["albedo"]}
        bsdf = {"type": "diffuse", "reflectance": albedo}
        if kind == "lambertian":
            return {"bsdf": {"type": "twosided", "bsdf": bsdf}}
        radiance = {"type": "rgb", "value": values["radiance"]}
        return {"bsdf": bsdf, "emitter": {"type": "area", "radiance": radiance}}


def read(tree, kind):
    """A part of the scene, none of whose keys would be overlooked."""
    if kind not in FIELDS:
        raise Unsupported(f"`{kind}` is not translated")
    unknown = sorted(set(tree) - FIELDS[kind])
    if unknown:
        raise Unsupported(f"`{kind}` with `{unknown[0]}` is not translated")
    return tree


def material(item):
    name, tree = item
    [(kind, values)] = tree.items()
    values = dict(read(values, kind))
    values.setdefault("albedo", [0, 0, 0])
    if kind not in ("lambertian", "emitter"):
        raise Unsupported(f"material `{kind}` is not translated")
    return name, (kind, values)


def is_parallelogram(vertices):
    v0, v1, v2, v3 = vertices
    return numpy.allclose(v0 + v2, v1 + v3, rtol=0, atol=1e-9 * numpy.ptp(vertices))


def mesh(geometry, folder):
    """The triangles of an OBJ file: scaled, turned about x, then y, then z, and moved."""
    if "material" not in geometry:
        raise Unsupported("a mesh with the materials of its file is not translated")
    turn = numpy.eye(3)
    for axis, degrees in enumerate(geometry.get("rotate", [0, 0, 0])):
        sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        around = numpy.eye(3)
        a, b = (axis + 1) % 3, (axis + 2) % 3
        around[a, a], around[a, b], around[b, a], around[b, b] = cos, -sin, sin, cos
        turn = around @ turn
    scale, move = geometry.get("scale", 1), geometry.get("translate", [0, 0, 0])
    vertices, triangles = [], []
    for line in (folder / geometry["obj"]).read_text().splitlines():
        match line.split():
            case ["v", *numbers]:
                vertices.append(turn @ (scale * numpy.array(numbers[:3], dtype=float)) + move)
            case ["f", *corners]:
                ids = [int(corner.split("/")[0]) for corner in corners]
                points = [vertices[id - 1 if id > 0 else id] for id in ids]
                for k in range(2, len(points)):
                    triangles.append(numpy.array([points[0], points[k - 1], points[k]]))
    return triangles


def write_ply(path, triangles):
    """A binary PLY file of triangles that share vertices where these are equal."""
    points = numpy.array(triangles, dtype="<f4").reshape(-1, 3)
    vertices, faces = numpy.unique(points, axis=0, return_inverse=True)
    faces = faces.reshape(-1, 3)
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    records = numpy.empty(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    records["count"], records["corners"] = 3, faces
    path.write_bytes(header.encode() + vertices.tobytes() + records.tobytes())
