"""MuJoCo on the scenes of boxes of `cargo xtask bench dynamics`; `cargo xtask report` shows its rows beside ours.

usage: mujoco_scenes.py [NAME ...]       (scenes whose names contain one of these; default: all)
install: pip install numpy mujoco

Reads `.bench/dynamics/scenes`, where the bench writes its scenes, and writes `.bench/dynamics/mujoco.csv`. MuJoCo takes a mesh for its
convex hull, so scenes with other bodies than boxes are left out. Its options are those that it comes with; the step is the scene's.
"""
import json
import math
import pathlib
import sys
import time

import mujoco
import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parents[3] / ".bench" / "dynamics"
HEADER = ("scene,by,version,threads,bodies,triangles,steps,simulated_s,wall_s,cpu_s,real_time,settled,"
          "median_us,worst_us,events,skipped_s,intersecting,asked,fault")
# As in the bench: the last simulated second is called settled.
SETTLED = 1.0


def words(numbers):
    return " ".join(repr(float(x)) for x in numbers)


def half_sides(path):
    """Of a box about the origin; None for another mesh."""
    lines = (line.split() for line in path.read_text().splitlines())
    vertices = np.array([[float(x) for x in line[1:4]] for line in lines if line and line[0] == "v"])
    most = np.abs(vertices).max(axis=0)
    return most if len(vertices) == 8 and (np.abs(vertices) == most).all() else None


class Box:
    """A body of a scene: how it starts, and its half sides."""

    def __init__(self, index, value, half):
        self.index, self.half, self.is_dynamic = index, half, value["kind"] == "dynamic"
        self.name, self.friction = f"body{index}", value["friction"]
        pose, velocity = value["pose"], value.get("velocity", {"v": [0, 0, 0], "w": [0, 0, 0]})
        self.x, self.q = np.array(pose["x"], dtype=float), np.array(pose["q"], dtype=float)
        self.v, self.w = velocity["v"], velocity["w"]

    def element(self, at, inside):
        """The body in its parent, whose origin is at `at`: the scenes' joined bodies start unturned."""
        return (f'<body name="{self.name}" pos="{words(self.x - at)}" quat="{words(self.q)}">{inside}'
                f'<geom type="box" size="{words(self.half)}" friction="{self.friction!r} 0 0" density="1000"/></body>')


def boxes_of(scene, folder):
    """The scene's bodies; None if one of them is no box, or is moved."""
    halves = {mesh: half_sides(folder / mesh) for mesh in {body["mesh"] for body in scene["bodies"]}}
    if any(half is None for half in halves.values()) or any(b["kind"] == "kinematic" for b in scene["bodies"]):
        return None
    return [Box(k, body, halves[body["mesh"]]) for k, body in enumerate(scene["bodies"])]


def model_of(scene, boxes):
    """MuJoCo's model: free bodies, and trees of those that hang on hinges. Jointed bodies do not touch each other."""
    of_name = {body["name"]: box for body, box in zip(scene["bodies"], boxes)}
    hinges = {}
    for joint in scene["joints"]:
        # A joint hangs its second body on its first, the first joint of a tree its first body on the world.
        child, parent = (joint["b"], joint["a"]) if joint["b"] else (joint["a"], None)
        hinges[child] = (parent, joint)
    names = list(of_name)

    def element(name, at):
        box, (parent, joint) = of_name[name], hinges.get(name, (None, None))
        inside = '<freejoint/>' if joint is None and box.is_dynamic else ""
        if joint is not None:
            assert (box.q == [1, 0, 0, 0]).all(), "a joined body that starts turned"
            inside = f'<joint type="hinge" pos="{words(joint["point"] - box.x)}" axis="{words(joint["axis"])}"/>'
        inside += "".join(element(n, box.x) for n in names if hinges.get(n, (None,))[0] == name)
        return box.element(at, inside)

    tops = [name for name in names if hinges.get(name, (None,))[0] is None]
    pairs = [(of_name[j["a"]].name, of_name[j["b"]].name) for j in scene["joints"] if j["b"]]
    apart = "".join(f'<exclude body1="{a}" body2="{b}"/>' for a, b in pairs)
    options = scene["simulation"]
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{options["step"]!r}" gravity="{words(options["gravity"])}"/>'
        f'<worldbody>{"".join(element(name, np.zeros(3)) for name in tops)}</worldbody><contact>{apart}</contact></mujoco>')


def overlap(a, b):
    """Whether two boxes (half sides, place, turn as a matrix) share points: no axis of a face or of two edges parts them."""
    (half_a, x_a, r_a), (half_b, x_b, r_b) = a, b
    axes = np.concatenate([r_a.T, r_b.T, np.cross(r_a.T[:, None], r_b.T[None]).reshape(9, 3)])
    reach = np.abs(axes @ r_a) @ half_a + np.abs(axes @ r_b) @ half_b
    return bool((np.abs(axes @ (x_b - x_a)) <= reach).all())


def intersecting(boxes, model, data):
    """Pairs of which at least one is dynamic; bodies that a joint holds are left out, as in our count."""
    placed = [(box.half, data.body(box.name).xpos, data.body(box.name).xmat.reshape(3, 3)) for box in boxes]
    excluded = {tuple(sorted((s >> 16, s & 0xffff))) for s in model.exclude_signature}
    ids = [model.body(box.name).id for box in boxes]
    count = 0
    for i, a in enumerate(placed):
        for j in range(i):
            if not (boxes[i].is_dynamic or boxes[j].is_dynamic) or tuple(sorted((ids[i], ids[j]))) in excluded:
                continue
            near = math.dist(a[1], placed[j][1]) <= np.linalg.norm(a[0]) + np.linalg.norm(placed[j][0])
            count += near and overlap(a, placed[j])
    return count


def row(name, scene, boxes):
    model = model_of(scene, boxes)
    data = mujoco.MjData(model)
    for box in boxes:
        body = model.body(box.name)
        if box.is_dynamic and model.jnt_type[body.jntadr[0]] == mujoco.mjtJoint.mjJNT_FREE:
            start = model.jnt_dofadr[body.jntadr[0]]
            data.qvel[start:start + 3] = box.v
            turn = np.zeros(9)
            mujoco.mju_quat2Mat(turn, box.q)
            data.qvel[start + 3:start + 6] = turn.reshape(3, 3).T @ box.w
    end, step = scene["simulation"]["end"], scene["simulation"]["step"]
    clocks, settled, processor = [], 0.0, 0.0
    steps = math.ceil(end / step)
    for k in range(steps):
        before, start = time.thread_time(), time.perf_counter()
        mujoco.mj_step(model, data)
        clocks.append(time.perf_counter() - start)
        took = time.thread_time() - before
        processor += took
        settled += took if end - k * step <= SETTLED else 0
    mujoco.mj_forward(model, data)
    dynamic = [box for box in boxes if box.is_dynamic]
    floor = any(not box.is_dynamic for box in boxes)
    lost = sum(data.body(box.name).xpos[1] < 0 for box in dynamic) if floor else 0
    fault = f"{lost} bodies fell through the floor" if lost else ""
    wall, simulated = sum(clocks), steps * step
    numbers = [f"{wall:.6f}", f"{processor:.4f}", f"{simulated / wall:.4f}",
               f"{min(SETTLED, simulated) / settled:.4f}" if settled else "",
               f"{np.median(clocks) * 1e6:.2f}", f"{max(clocks) * 1e6:.2f}"]
    count = intersecting(boxes, model, data)
    return ",".join([name, "MuJoCo", mujoco.__version__, "1", str(len(dynamic)), "12", str(steps), repr(simulated),
                     *numbers, "0", "0.0", str(count), "", fault])


def main(wanted):
    table = FOLDER / "dynamics.csv"
    if not table.exists():
        sys.exit(f"there is no {table}: run cargo xtask bench dynamics first")
    names = dict.fromkeys(line.split(",")[0] for line in table.read_text().splitlines()[1:])
    lines = [HEADER]
    for name in names:
        path = FOLDER / "scenes" / (name.replace(" ", "-").replace("/", "-") + ".json")
        if not path.exists() or wanted and not any(part in name for part in wanted):
            continue
        scene = json.loads(path.read_text())
        boxes = boxes_of(scene, path.parent)
        if boxes is None:
            print(f"left out: {name}, which has bodies that are no boxes", file=sys.stderr)
            continue
        lines.append(row(name, scene, boxes))
        print(lines[-1])
    (FOLDER / "mujoco.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
