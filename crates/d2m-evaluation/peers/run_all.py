"""The peers on trials of the bench; `cargo xtask report` shows what they did beside our own answers.

usage: run_all.py [--limit TRIALS] [--seconds S]     (defaults: 64 trials and 20 seconds a pair and speed)
install: pip install numpy python-fcl ipctk

Run it after `cargo xtask bench` and `cargo xtask bench --only scenes` on the same machine. A peer that is not installed is left out:
PQP and C2A are programs in `.bench/peers`, built as README.md says. Writes `fcl.csv`, `pqp.csv`, `c2a.csv`, `c2a-near.csv`,
`ipc.csv` and `distance.csv` there.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAIRS = ["gear/gear", "torus/torus", "pebble/pebble", "knot/knot"]


def cargo(*words):
    subprocess.run(["cargo", "run", "--release", "--quiet", *words], cwd=ROOT, check=True)


def trials_of_pairs():
    """Each pair and speed of the bench: its name, the speed, the files of both meshes and of the trials."""
    for pair in PAIRS:
        with tempfile.TemporaryDirectory() as folder:
            cargo("-p", "d2m-evaluation", "--", "trials", "--pair", pair, "--folder", folder)
            for trials in sorted(pathlib.Path(folder).glob("*.csv")):
                a, b, speed = trials.stem.split("__")
                yield pair, speed, [pathlib.Path(folder, f"{name}.obj") for name in (a, b)], trials


def timed(rows, seconds):
    """Numbered rows, until so many seconds are over."""
    begin = time.monotonic()
    for index, row in enumerate(rows):
        yield index, row
        if time.monotonic() - begin > seconds:
            return


def run_fcl(out, limit, seconds):
    import fcl_continuous

    lines = ["pair,speed,trial,advance_toc,advance_microseconds,distance_microseconds,"
             "continuous_toc,continuous_microseconds"]
    for pair, speed, models, trials in trials_of_pairs():
        for index, row in timed(fcl_continuous.rows(*models, trials, limit), seconds):
            lines.append(f"{pair},{speed},{index},{fcl_continuous.text(row)}")
        print(f"FCL on {pair} at speed {speed}: {index + 1} trials", file=sys.stderr)
    out.write_text("\n".join(lines) + "\n")


def printed(words):
    """The rows of a program, as they come."""
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as program:
        next(program.stdout, None)
        try:
            for line in program.stdout:
                yield line.strip()
        finally:
            program.terminate()


def run_program(out, name, header, limit, seconds, more=()):
    """Rows of a program of this name in `.bench/peers`."""
    program = out.with_name(name)
    if not program.exists():
        print(f"left out: there is no {program}", file=sys.stderr)
        return
    lines = [header]
    for pair, speed, models, trials in trials_of_pairs():
        rows = printed([str(program), *map(str, models), str(trials), str(limit), *more])
        for index, row in timed(rows, seconds):
            lines.append(f"{pair},{speed},{row}")
        print(f"{name} on {pair} at speed {speed}: {index + 1} trials", file=sys.stderr)
    out.write_text("\n".join(lines) + "\n")


def run_ipc(out, count):
    import ipc_nonlinear

    with tempfile.TemporaryDirectory() as folder:
        cases, answers = pathlib.Path(folder, "cases.jsonl"), pathlib.Path(folder, "answers.jsonl")
        ipc_nonlinear.write_cases(count, cases)
        cargo("-p", "d2m-cli", "--", "features", str(cases), "--out", str(answers))
        ours = [json.loads(line) for line in answers.read_text().splitlines()]
    lines = ["case,rescaling,planted,found,microseconds,d2m_found,d2m_microseconds"]
    for rescaling in [0.8, 0.999]:
        for case, ((toc, found, clock), own) in enumerate(zip(ipc_nonlinear.rows(count, rescaling), ours)):
            own_found = own["t_lo"] if own["status"] == "hit" else float("inf")
            lines.append(f"{case},{rescaling},{toc!r},{found!r},{clock:.1f},{own_found!r},{own['microseconds']}")
        print(f"IPC Toolkit, rescaling {rescaling}: {count} cases", file=sys.stderr)
    out.write_text("\n".join(lines) + "\n")


def run_distances(out):
    import fcl_distance

    if not (fcl_distance.FOLDER / "distance.csv").exists():
        print("left out: distances, without cargo xtask bench --only scenes", file=sys.stderr)
        return
    found = subprocess.run([sys.executable, fcl_distance.__file__], stdout=subprocess.PIPE, text=True, check=True)
    out.write_text(found.stdout)
    print("FCL's distances", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limit", type=int, default=64)
    parser.add_argument("--seconds", type=float, default=20)
    options = parser.parse_args()
    folder = ROOT / ".bench" / "peers"
    folder.mkdir(parents=True, exist_ok=True)
    limits = options.limit, options.seconds
    pqp = "pair,speed,trial,advance_toc,advance_microseconds,collide_microseconds,distance_microseconds"
    c2a = "pair,speed,trial,toc,microseconds,separation"
    for name, run in [("fcl.csv", lambda out: run_fcl(out, *limits)),
                      ("pqp.csv", lambda out: run_program(out, "pqp", pqp, *limits)),
                      ("c2a.csv", lambda out: run_program(out, "c2a", c2a, *limits)),
                      ("c2a-near.csv", lambda out: run_program(out, "c2a", c2a, *limits, ["1e-9"])),
                      ("ipc.csv", lambda out: run_ipc(out, 2 * options.limit)),
                      ("distance.csv", run_distances)]:
        try:
            run(folder / name)
        except ImportError as error:
            print(f"left out: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
