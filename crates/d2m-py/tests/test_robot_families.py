"""Robots of six kinds, read from files of every format, against python-fcl at many samples with kinematics of our own."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import d2m_ccd
import numpy as np
import pytest

fcl = pytest.importorskip("fcl")

SAMPLES = 300
#: What rounded poses and distances may be off, meters.
ROUNDING = 1e-9

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)


def stl_in_text(vertices: np.ndarray) -> bytes:
    lines = ["solid part"]
    for face in FACES:
        corners = [f"vertex {x!r} {y!r} {z!r}" for x, y, z in vertices[face].tolist()]
        lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
    return ("\n".join([*lines, "endsolid part"]) + "\n").encode()


def stl(vertices: np.ndarray) -> bytes:
    triangles = [np.concatenate([np.zeros(3), vertices[face].ravel()]).astype("<f4").tobytes() + b"\0\0" for face in FACES]
    return b"solid but binary".ljust(80) + struct.pack("<I", len(FACES)) + b"".join(triangles)


def glb(vertices: np.ndarray) -> bytes:
    points, indices = vertices.astype("<f4").tobytes(), FACES.astype("<u2").tobytes()
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-9] * 3, "max": [9] * 3},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(points)},
            {"buffer": 0, "byteOffset": len(points), "byteLength": len(indices)},
        ],
        "buffers": [{"byteLength": len(points) + len(indices)}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = points + indices
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def dae(vertices: np.ndarray) -> bytes:
    """In millimeters by its own unit, turned by its node: a quarter about x takes (x, −z, y) back."""
    numbers = " ".join(repr(number) for x, y, z in (1000 * vertices).tolist() for number in (x, z, -y))
    places = " ".join(str(place) for face in FACES for place in face)
    return f"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="24">{numbers}</float_array><technique_common><accessor source="#a" count="8" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{places}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><rotate>1 0 0 90</rotate><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


def obj(vertices: np.ndarray) -> bytes:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()] + [f"f {a} {b} {c}" for a, b, c in (FACES + 1).tolist()]
    return "\n".join(lines).encode()


FORMATS = {"stl": stl_in_text, "bin.stl": stl, "glb": glb, "dae": dae, "obj": obj}


def turn(axis: Any, angle: float) -> np.ndarray:
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def frame(xyz: Any = (0, 0, 0), rpy: Any = (0, 0, 0), rotation: Any = None) -> np.ndarray:
    made = np.eye(4)
    roll, pitch, yaw = rpy
    turned = turn([0, 0, 1], yaw) @ turn([0, 1, 0], pitch) @ turn([1, 0, 0], roll)
    made[:3, :3], made[:3, 3] = turned if rotation is None else rotation, xyz
    return made


@dataclass
class Body:
    """A box of a link: half sizes, where it is in the link, as which format, scaled by what."""

    half: Any
    xyz: Any = (0, 0, 0)
    rpy: Any = (0, 0, 0)
    kind: str = "box"
    scale: Any = (1, 1, 1)


@dataclass
class Link:
    """A link with the joint that carries it."""

    name: str
    parent: str | None = None
    joint: str = ""
    kind: str = "fixed"
    xyz: Any = (0, 0, 0)
    rpy: Any = (0, 0, 0)
    axis: Any = None
    mimic: tuple[str, float, float] | None = None
    bodies: list[Body] = field(default_factory=list)

    def moved(self, q: dict[str, float]) -> np.ndarray:
        if self.kind == "planar":
            x, y, theta = (q[f"{self.joint}/{part}"] for part in ("x", "y", "theta"))
            return frame((x, y, 0)) @ frame(rotation=turn([0, 0, 1], theta))
        if self.kind == "floating":
            return frame([q[f"{self.joint}/trans_{part}"] for part in "xyz"])
        if self.kind == "fixed":
            return np.eye(4)
        value = q[self.joint] if self.mimic is None else self.mimic[1] * q[self.mimic[0]] + self.mimic[2]
        q[self.joint] = value
        axis = np.array([1, 0, 0] if self.axis is None else self.axis, float)
        if self.kind == "prismatic":
            return frame(value * axis / np.linalg.norm(axis))
        return frame(rotation=turn(axis, value))

    def free(self) -> list[str]:
        if self.kind == "planar":
            return [f"{self.joint}/{part}" for part in ("x", "y", "theta")]
        if self.kind == "floating":
            return [f"{self.joint}/trans_{part}" for part in "xyz"]
        return [] if self.kind == "fixed" or self.mimic else [self.joint]


def numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)


def urdf(links: list[Link], folder: Path) -> str:
    parts = ['<robot name="family">']
    for link in links:
        parts.append(f'<link name="{link.name}">')
        for place, body in enumerate(link.bodies):
            shape = f'<box size="{numbers(2 * np.array(body.half))}"/>'
            if body.kind != "box":
                name = f"{link.name}-{place}.{body.kind}"
                scale = np.array(body.scale, float)
                (folder / name).write_bytes(FORMATS[body.kind](CORNERS * (np.array(body.half) / scale)))
                shape = f'<mesh filename="{name}" scale="{numbers(scale)}"/>'
            origin = f'<origin xyz="{numbers(body.xyz)}" rpy="{numbers(body.rpy)}"/>'
            parts.append(f"<collision>{origin}<geometry>{shape}</geometry></collision>")
        parts.append("</link>")
        if link.parent is None:
            continue
        axis = "" if link.axis is None else f'<axis xyz="{numbers(link.axis)}"/>'
        mimic = "" if link.mimic is None else '<mimic joint="{}" multiplier="{}" offset="{}"/>'.format(*link.mimic)
        parts.append(
            f'<joint name="{link.joint}" type="{link.kind}"><parent link="{link.parent}"/><child link="{link.name}"/>'
            f'<origin xyz="{numbers(link.xyz)}" rpy="{numbers(link.rpy)}"/>{axis}{mimic}<limit lower="-9" upper="9" velocity="9"/></joint>'
        )
    parts.append('<transmission name="t"><joint name="none"><x/></joint></transmission></robot>')
    return "\n".join(parts)


def scara() -> list[Link]:
    arm = [Body((0.2, 0.04, 0.03), (0.2, 0, 0), kind="stl", scale=(0.001, 0.001, 0.001))]
    return [
        Link("base", bodies=[Body((0.1, 0.1, 0.2), (0, 0, -0.22))]),
        Link("one", "base", "j1", "revolute", axis=(0, 0, 3), bodies=arm),
        Link("two", "one", "j2", "revolute", (0.4, 0, 0.08), axis=(0, 0, 0.5), bodies=arm),
        Link("quill", "two", "j3", "prismatic", (0.4, 0, 0), axis=(0, 0, -1), bodies=[Body((0.02, 0.02, 0.2))]),
        Link("tool", "quill", "j4", "continuous", (0, 0, -0.25), axis=(0, 0, 1), bodies=[Body((0.12, 0.02, 0.02), (0.05, 0, 0))]),
    ]


def gantry() -> list[Link]:
    tool = Body((0.05, 0.03, 0.15), (0, 0, -0.1), (0.1, 0.2, 0.3), "dae", (2, 0.5, 1))
    return [
        Link("floor", bodies=[Body((0.8, 0.8, 0.02), (0, 0, -0.6)), Body((0.05, 0.05, 0.3), (0.6, 0.6, -0.25))]),
        Link("x", "floor", "jx", "prismatic", bodies=[Body((0.02, 0.7, 0.02), (0, 0, 0.9))]),
        Link("y", "x", "jy", "prismatic", axis=(0, 7, 0), bodies=[Body((0.06, 0.06, 0.06), (0, 0, 0.8))]),
        Link("z", "y", "jz", "prismatic", (0, 0, -0.1), axis=(0, 0, 1), bodies=[tool]),
    ]


def mobile() -> list[Link]:
    arm = [Body((0.02, 0.02, 0.2), (0, 0, 0.2), kind="glb", scale=(0.5, 1, 2))]
    return [
        Link("map"),
        Link("chassis", "map", "base", "planar", (0, 0, 0.1), axis=(0, 0, 1), bodies=[Body((0.2, 0.15, 0.08))]),
        Link("mast", "chassis", "weld", "fixed", (0.1, 0, 0.1), axis=(0, 0, 0), bodies=[Body((0.02, 0.02, 0.15), (0, 0, 0.15))]),
        Link("upper", "mast", "a", "continuous", (0, 0, 0.33), axis=(0, 1, 0), bodies=arm),
        Link("lower", "upper", "b", "continuous", (0, 0.05, 0.4), axis=(0, -2, 0), bodies=arm),
    ]


def dual() -> list[Link]:
    links = [Link("torso", bodies=[Body((0.08, 0.2, 0.3), (0, 0, -0.1))])]
    for side, sign in (("left", 1), ("right", -1)):
        arm = [Body((0.03, 0.03, 0.15), (0, 0, 0.15), kind="bin.stl", scale=(1, -1, 1))]
        finger = [Body((0.01, 0.005, 0.05), (0, 0, 0.05))]
        links += [
            Link(f"{side}_upper", "torso", f"{side}_a", "revolute", (0.12, 0.2 * sign, 0.1), (0.3 * sign, 0.2, 0), (0, 1, 0), bodies=arm),
            Link(f"{side}_lower", f"{side}_upper", f"{side}_b", "revolute", (0.03, 0, 0.33), axis=(1, 0, 0), bodies=arm),
            Link(f"{side}_f1", f"{side}_lower", f"{side}_g", "prismatic", (0, 0.02, 0.31), axis=(0, 1, 0), bodies=finger),
            Link(f"{side}_f2", f"{side}_lower", f"{side}_h", "prismatic", (0, -0.02, 0.31), axis=(0, -1, 0), mimic=(f"{side}_g", 1.0, 0.0), bodies=finger),
            Link(f"{side}_f3", f"{side}_lower", f"{side}_i", "revolute", (0.02, 0, 0.31), axis=(0, 0, 1), mimic=(f"{side}_h", -4.0, 0.1), bodies=finger),
        ]
    return links


def posed_root() -> list[Link]:
    arm = [Body((0.15, 0.02, 0.03), (0.15, 0, 0), kind="obj", scale=(-1, 2, 1))]
    return [
        Link("world"),
        Link("base", "world", "root", "fixed", (0.1, -0.2, 0.3), (0.4, -0.3, 1.57079632679), bodies=[Body((0.1, 0.1, 0.05))]),
        Link("one", "base", "p1", "revolute", (0, 0, 0.1), (0, 0, 3.14159265359), (0.3, 0.2, 1), bodies=arm),
        Link("two", "one", "p2", "revolute", (0.32, 0, 0.05), (1.57079632679, 0, 0), bodies=arm),
        Link("three", "two", "p3", "revolute", (0.3, 0.07, 0), axis=(0, 1, 0), bodies=[*arm, Body((0.02, 0.1, 0.02), (0.3, 0, 0))]),
    ]


def floating() -> list[Link]:
    return [
        Link("space", bodies=[Body((0.2, 0.02, 0.2), (0, 0.5, 0))]),
        Link("hull", "space", "float", "floating", (0, 0, 0.1), (0, 0, 0.7), bodies=[Body((0.1, 0.15, 0.05), kind="stl", scale=(0.001, 0.002, 0.001))]),
        Link("wing", "hull", "flap", "revolute", (0.12, 0, 0), axis=(0, 1, 0), bodies=[Body((0.15, 0.1, 0.01), (0.16, 0, 0))]),
        Link("tip", "wing", "fold", "revolute", (0.32, 0, 0), axis=(0, 1, 0), bodies=[Body((0.15, 0.1, 0.01), (0.16, 0, 0))]),
    ]


FAMILIES = [scara, gantry, mobile, dual, posed_root, floating]


class Model:
    """The robot, its obstacles and what it carries, by numpy and python-fcl."""

    def __init__(self, links: list[Link]) -> None:
        self.links = links
        self.bodies: list[tuple[str, str, np.ndarray, Any]] = []
        for link in links:
            for body in link.bodies:
                self.add(link.name, link.name, frame(body.xyz, body.rpy), body.half)
        self.moving: dict[str, Any] = {}

    def add(self, name: str, carrier: str, place: np.ndarray, half: Any) -> None:
        model = fcl.BVHModel()
        model.beginModel(8, 12)
        model.addSubModel(CORNERS * np.array(half), FACES)
        model.endModel()
        self.bodies.append((name, carrier, place, fcl.CollisionObject(model, fcl.Transform())))

    def pairs(self) -> list[tuple[int, int]]:
        joined = {frozenset((link.name, link.parent)) for link in self.links}
        links = {link.name for link in self.links}

        def checked(a: int, b: int) -> bool:
            (one, carrier, *_), (other, other_carrier, *_) = self.bodies[a], self.bodies[b]
            if one in links and other in links:
                return one != other and frozenset((one, other)) not in joined
            if one in self.moving and other in self.moving:
                return False
            # Carried: not against its own link.
            return one in self.moving or other in self.moving or carrier != other_carrier

        count = len(self.bodies)
        return [(a, b) for a in range(count) for b in range(a + 1, count) if checked(a, b)]

    def place(self, q: dict[str, float], time: float) -> None:
        frames: dict[str, np.ndarray] = {}
        for link in self.links:
            before = np.eye(4) if link.parent is None else frames[link.parent]
            frames[link.name] = before if link.parent is None else before @ frame(link.xyz, link.rpy) @ link.moved(q)
        for name, carrier, local, shape in self.bodies:
            if name in self.moving:
                x, v, w = self.moving[name]
                speed = np.linalg.norm(w)
                world = frame(x + v * time, rotation=turn(w, speed * time) if speed > 0 else np.eye(3))
            else:
                world = frames[carrier] @ local
            shape.setTransform(fcl.Transform(world[:3, :3], world[:3, 3]))

    def gap(self, pair: tuple[int, int]) -> float:
        a, b = (self.bodies[place][3] for place in pair)
        if fcl.collide(a, b, fcl.CollisionRequest(), fcl.CollisionResult()) > 0:
            return 0.0
        return float(fcl.distance(a, b, fcl.DistanceRequest(), fcl.DistanceResult()))


def hermite(times: np.ndarray, points: np.ndarray, rates: np.ndarray | None, time: float) -> np.ndarray:
    piece = min(max(int(np.searchsorted(times, time, side="right")) - 1, 0), len(times) - 2)
    h = times[piece + 1] - times[piece]
    u = (time - times[piece]) / h
    w = 1 - u
    p, q = points[piece], points[piece + 1]
    if rates is None:
        return p * w + q * u
    v0, v1 = rates[piece] * h, rates[piece + 1] * h
    return p * w * w * (1 + 2 * u) + q * u * u * (3 - 2 * u) + v0 * u * w * w - v1 * u * u * w


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
def test_nothing_late_nothing_missed_the_right_pair(family: Any, tmp_path: Path) -> None:
    links = family()
    (tmp_path / "family.urdf").write_text(urdf(links, tmp_path))
    random = np.random.default_rng(sum(map(ord, family.__name__)))
    contacts = frees = 0
    for round in range(8):
        separation = [0.0, 0.01][round % 2]
        robot = d2m_ccd.Robot(tmp_path / "family.urdf", min_separation=separation)
        assert robot.joint_names == [name for link in links for name in link.free()]
        model = Model(links)
        for k in range(2 + round % 2):
            half, x = random.uniform(0.02, 0.15, 3), random.normal(size=3)
            x *= random.uniform(0.4, 0.9) / np.linalg.norm(x)
            v, w = (random.normal(size=3) * [0.0, 0.4][k % 2] for _ in range(2))
            size = "shape:box?x={}&y={}&z={}".format(*half.tolist())
            if k % 2:
                robot.add_obstacle(f"o{k}", size, motion=d2m_ccd.ConstantTwist(x=x, v=v, w=w))
            else:
                robot.add_obstacle(f"o{k}", size, d2m_ccd.Pose(x=x))
            model.moving[f"o{k}"] = (x, v, w)
            model.add(f"o{k}", f"o{k}", np.eye(4), half)
        if round % 3 == 0:
            last, half = links[-1].name, [0.015, 0.02, 0.06]
            turned = d2m_ccd.Pose(x=[0.05, 0.02, 0.1], q=[1, 0.2, 0, 0.1])
            robot.attach("carried", last, "shape:box?x={}&y={}&z={}".format(*half), turned)
            model.add("carried", last, turned.matrix(), half)
        pairs = model.pairs()
        names = robot.joint_names
        for path in range(6):
            count = [2, 2, 3][path % 3]
            times = np.cumsum(random.uniform(0.2, 0.8, count)) if path % 2 else np.array([0.0, *range(1, count)])
            size = [0.15, 0.6, 2.0][path % 3]
            points = random.uniform(-0.4, 0.4, (1, len(names))) + np.concatenate(
                [np.zeros((1, len(names))), random.uniform(-size, size, (count - 1, len(names)))]
            )
            rates = random.uniform(-1, 1, points.shape) if path % 2 else None
            answer = robot.check_path(times, points, rates)
            if count == 2 and rates is None:
                edge = robot.check_edge(points[0], points[1])
                assert (edge.status, edge.free_until) == (answer.status, answer.free_until)

            def gaps(time: float) -> np.ndarray:
                q = dict(zip(names, hermite(times, points, rates, time)))
                model.place(q, time)
                return np.array([model.gap(pair) for pair in pairs])

            until = answer.free_until
            for time in np.linspace(times[0], until, SAMPLES)[:-1] if until > times[0] else []:
                least = gaps(time)
                assert least.min() > separation - ROUNDING, (round, path, time, pairs[int(least.argmin())])
            assert answer.status in ("contact", "free")
            if answer.status == "free":
                frees += 1
                assert until == times[-1] and gaps(until).min() > separation - ROUNDING
                continue
            contacts += 1
            least = gaps(answer.contact.time_hi)
            of_pair = [gap for gap, (a, b) in zip(least, pairs) if {model.bodies[a][0], model.bodies[b][0]} == {answer.a, answer.b}]
            # One that is inside of the other at the start touches no surface: fcl sees surfaces only.
            assert min(of_pair) <= separation + 1e-7 or answer.contact.start == "contained", (round, path, answer)
            if until > times[0]:
                assert min(of_pair) <= least.min() + 1e-7
    assert contacts > 5 and frees > 5, (contacts, frees)
