"""Both peers on trials of the bench; `cargo xtask report` shows what they did beside our own answers.

usage: run_all.py [--limit TRIALS] [--seconds S]     (defaults: 64 trials and 20 seconds a pair and speed)
install: pip install numpy python-fcl ipctk

Run it after `cargo xtask bench` and `cargo xtask bench --only scenes` on the same machine. A peer that is not installed is left out.
Writes `fcl.csv`, `ipc.csv` and `distance.csv` in `.bench/peers`.
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


def run_fcl(out, limit, seconds):
    import fcl_continuous

    lines = ["pair,speed,trial,advance_toc,advance_microseconds,distance_microseconds,"
             "continuous_toc,continuous_microseconds"]
    for pair in PAIRS:
        with tempfile.TemporaryDirectory() as folder:
            cargo("-p", "d2m-evaluation", "--", "trials", "--pair", pair, "--folder", folder)
            for trials in sorted(pathlib.Path(folder).glob("*.csv")):
                a, b, speed = trials.stem.split("__")
                models = [pathlib.Path(folder, f"{name}.obj") for name in (a, b)]
                begin = time.monotonic()
                for index, row in enumerate(fcl_continuous.rows(*models, trials, limit)):
                    lines.append(f"{pair},{speed},{index},{fcl_continuous.text(row)}")
                    if time.monotonic() - begin > seconds:
                        break
                print(f"FCL on {pair} at speed {speed}: {index + 1} trials", file=sys.stderr)
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
    for name, run in [("fcl.csv", lambda out: run_fcl(out, options.limit, options.seconds)),
                      ("ipc.csv", lambda out: run_ipc(out, 2 * options.limit)),
                      ("distance.csv", run_distances)]:
        try:
            run(folder / name)
        except ImportError as error:
            print(f"left out: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
