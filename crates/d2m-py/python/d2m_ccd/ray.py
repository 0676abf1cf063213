"""Batches over a cluster, by Ray (`pip install "d2m-ccd[ray]"`).

The trees go into Ray's object store once and are read once by each worker process; trials go out in chunks, a bounded number of
which are in flight; results come back in order, with the bits of one machine. A worker or a node that dies loses nothing: its
chunks run again elsewhere.

    import d2m_ccd.ray
    results = d2m_ccd.ray.batch(tree_a, tree_b, motions_a, motions_b)     # as d2m_ccd.batch
    for part in d2m_ccd.ray.stream(tree_a, tree_b, chunks, reduce=count):  # more than fits into one machine

    python -m d2m_ccd.ray A.obj B.obj --trials T.csv --out R.csv --workers 8
    python -m d2m_ccd.ray A.obj B.obj --trials T.csv --out R.csv --address auto
"""

from __future__ import annotations

import argparse
import collections
import hashlib
import os
import pickle
import sys
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Callable, Optional, Union

import numpy as np

from . import batch as _batch_here
from ._d2m import Robot, Tree
from ._errors import InputError
from ._records import EDGE, RESULT
from ._trials import Trials, read_trials, write_results

try:
    import ray
except ImportError as error:  # pragma: no cover
    raise ImportError("d2m_ccd.ray needs Ray: pip install 'd2m-ccd[ray]'") from error

#: A chunk should take about so long: long against the millisecond that a task costs, short against what a lost one costs.
CHUNK_SECONDS = 0.5
#: The first chunks, before it is known how long a trial takes; no chunk is smaller unless no more is left.
LEAST_CHUNK = 64
#: About 25 MB of trials and results.
MOST_CHUNK = 65_536
#: So many times as many chunks as are in flight may wait, with their results, for one before them.
_MOST_HELD = 4


@dataclass(frozen=True)
class Edges:
    """Edges of a robot: configurations of shape (n, j) twice, and the names of the j joints (`None`: those of the robot)."""

    start: Any
    end: Any
    joints: Any = None

    def __len__(self) -> int:
        return len(self.start)


#: Trials or edges, or a function that makes them where they are run.
Chunk = Union[Trials, Edges, Callable[[], Any]]
#: What becomes of the results of a chunk where they are made.
Reduce = Optional[Callable[[Trials, Any], Any]]


@dataclass(frozen=True)
class _Shared:
    """A tree or a robot in the object store, by the hash of its bytes."""

    key: str
    stored: Any

    @classmethod
    def put(cls, made: Tree | Robot) -> _Shared:
        data = pickle.dumps(made, protocol=5)
        return cls(hashlib.sha256(data).hexdigest(), ray.put(data))


#: The trees and robots that this worker process has read, latest last.
_READ: collections.OrderedDict[str, Any] = collections.OrderedDict()
_MOST_READ = 64


def _read(shared: _Shared) -> Any:
    if shared.key not in _READ:
        _READ[shared.key] = pickle.loads(ray.get(shared.stored))
        while len(_READ) > _MOST_READ:
            _READ.popitem(last=False)
    _READ.move_to_end(shared.key)
    return _READ[shared.key]


@dataclass(frozen=True)
class _Done:
    """Results of a chunk, and the seconds that its worker took."""

    results: Any
    seconds: float


def _run_chunk(shared: list[_Shared], chunk: Chunk, options: dict[str, Any], reduce: Reduce) -> _Done:
    of = [_read(one) for one in shared]
    start = time.perf_counter()
    made = chunk() if callable(chunk) else chunk
    if isinstance(made, Edges):
        results = of[0].check_edges(made.start, made.end, joints=made.joints, threads=1, **options)
    else:
        results = _batch_here(*of, made.motions_a, made.motions_b, window=made.window, threads=1, **options)
    return _Done(results if reduce is None else reduce(made, results), time.perf_counter() - start)


@dataclass
class _InFlight:
    """A chunk that was sent out."""

    task: Any
    chunk: Chunk
    first: int
    tries: int


class _Sender:
    """Sends chunks out, at most `in_flight` at a time, and gives their results in order."""

    def __init__(
        self, of: list[Any], in_flight: int | None, retries: int, options: dict[str, Any], reduce: Reduce = None
    ) -> None:
        if not ray.is_initialized():
            ray.init(log_to_driver=False)
        self._shared = [_Shared.put(one) for one in of]
        # In the store once, too: `reduce` may hold as much as it likes.
        self._options, self._reduce = options, ray.put(reduce)
        resources = ray.cluster_resources()  # type: ignore[no-untyped-call]
        self.workers = max(1, int(resources.get("CPU", 1)))
        self._in_flight = in_flight or 2 * self.workers
        self._retries = retries
        # Ray runs tasks of workers that died again by itself; what it gives up on, we send out again.
        self._remote = ray.remote(num_cpus=1, max_retries=retries)(_run_chunk)

    def _task(self, chunk: Chunk) -> Any:
        return self._remote.remote(self._shared, chunk, self._options, self._reduce)

    def run(self, chunks: Iterable[Chunk]) -> Iterator[_Done]:
        """Results in the order of the chunks; those are taken from the iterator as workers become free."""
        waiting: collections.deque[_InFlight] = collections.deque()
        running: set[Any] = set()
        source = _numbered(chunks)

        def fill() -> None:
            # Behind a slow chunk others go on, and their results are held: so many at most.
            while len(running) < self._in_flight and len(waiting) < _MOST_HELD * self._in_flight:
                following = next(source, None)
                if following is None:
                    return
                first, chunk = following
                waiting.append(_InFlight(self._task(chunk), chunk, first, 0))
                running.add(waiting[-1].task)

        # Where this ends early, what is in flight runs to its end: `ray.cancel` of a task that ends at that moment may end the process of the
        # caller (Ray's "Tried to complete task that was not pending").
        while True:
            fill()
            if not waiting:
                return
            while waiting[0].task in running:
                ended, _ = ray.wait(list(running), num_returns=1)
                running.difference_update(ended)
                fill()
            done = self._receive(waiting[0])
            if done is None:
                running.add(waiting[0].task)
                continue
            waiting.popleft()
            yield done

    def _receive(self, chunk: _InFlight) -> _Done | None:
        """The results of a chunk that has ended; none if it was lost and sent out again."""
        try:
            done: _Done = ray.get(chunk.task)
        except ray.exceptions.RayTaskError as error:
            cause = getattr(error, "cause", error)
            if isinstance(cause, InputError):
                raise _moved(cause, chunk.first) from None
            raise
        except ray.exceptions.RayError:
            if chunk.tries >= self._retries:
                raise
            chunk.tries += 1
            chunk.task = self._task(chunk.chunk)
            return None
        return done


def _numbered(chunks: Iterable[Chunk]) -> Iterator[tuple[int, Chunk]]:
    """Each chunk with the number of its first trial; of chunks that are functions trials are numbered from 0 in each."""
    first = 0
    for chunk in chunks:
        if callable(chunk):
            yield 0, chunk
        else:
            yield first, chunk
            first += len(chunk)


def _moved(error: InputError, first: int) -> InputError:
    """The error of a chunk, with the trial's number among all."""
    if not isinstance(error.index, int):
        return InputError(str(error.args[0]), error.index, error.value)
    text = str(error.args[0])
    for one in ("trial", "edge"):
        text = text.replace(f"{one} {error.index}:", f"{one} {first + error.index}:", 1)
    return InputError(text, first + error.index, error.value)


def stream(
    a: Any,
    b: Any,
    chunks: Iterable[Chunk],
    *,
    reduce: Reduce = None,
    in_flight: int | None = None,
    retries: int = 5,
    **options: Any,
) -> Iterator[Any]:
    """Results of chunks of trials, in order, while others are computed: for more than fits into memory.

    `chunks`: an iterable of `Trials(motions_a, motions_b, window)`, or of functions that make them on the worker (from a seed, from a
    file), taken as workers become free; at most `in_flight` of them run at a time (by default twice the cluster's processors).
    `reduce(trials, results)`, if given, is called on the worker, and what it returns is yielded: counts, or a file's name, instead
    of 192 bytes a trial. Other arguments as of `d2m_ccd.batch`. Yields structured arrays with the fields of `d2m_ccd.RESULT` otherwise.
    Where an error ends it, or nobody asks for more, the chunks in flight run to their end and their results are dropped.
    """
    for done in _Sender([_tree(a), _tree(b)], in_flight, retries, options, reduce).run(chunks):
        yield done.results


def stream_edges(
    robot: Robot,
    chunks: Iterable[Chunk],
    *,
    reduce: Reduce = None,
    in_flight: int | None = None,
    retries: int = 5,
) -> Iterator[Any]:
    """As `stream`, of chunks of `Edges(start, end, joints)` of a robot, or of functions that make them on the worker.

    The robot travels with its meshes and scene, once a node. Yields structured arrays with the fields of `d2m_ccd.EDGE`, or what
    `reduce(edges, results)` returns.
    """
    for done in _Sender([robot], in_flight, retries, {}, reduce).run(chunks):
        yield done.results


def check_edges(
    robot: Robot,
    start: Any,
    end: Any,
    *,
    joints: Any = None,
    in_flight: int | None = None,
    retries: int = 5,
    progress: Any = None,
) -> Any:
    """As `Robot.check_edges`, over the cluster that Ray is connected to (the processors of this machine if it is to none).

    The same bits as on one machine, in order; other arguments as of `batch`. Raises `InputError` with the first edge that cannot be checked as
    `index`.
    """
    start, end = np.asarray(start), np.asarray(end)
    if start.ndim != 2 or start.shape != end.shape:
        raise InputError(f"start has the shape {start.shape} and end {end.shape}: (n, j) twice is expected", None, None)
    sender = _Sender([robot], in_flight, retries, {})
    return _run(sender, _SizedEdges(Edges(start, end, joints), len(start)), progress)[0]


def _tree(any: Any) -> Tree:
    return any if isinstance(any, Tree) else Tree(any)


def batch(
    a: Any,
    b: Any,
    motions_a: Any = None,
    motions_b: Any = None,
    *,
    window: Any = None,
    in_flight: int | None = None,
    retries: int = 5,
    progress: Any = None,
    **options: Any,
) -> Any:
    """As `d2m_ccd.batch`, over the cluster that Ray is connected to (the processors of this machine if it is to none).

    The same bits as on one machine, in order. `retries`: how often a chunk is run again whose worker or node died. Raises `InputError`
    with the first trial that cannot be answered as `index`.
    """
    trials = _all_trials(motions_a, motions_b, window)
    return _run(_Sender([_tree(a), _tree(b)], in_flight, retries, options), trials, progress)[0]


def _all_trials(motions_a: Any, motions_b: Any, window: Any) -> _Sized:
    parts = [part for part in (motions_a, motions_b) if _is_several(part)]
    if window is not None and np.ndim(window) == 2:
        parts.append(window)
    counts = sorted({len(part) for part in parts})
    if len(counts) > 1:
        raise InputError(f"the motions and windows are of {counts[0]} and of {counts[1]} trials", None, tuple(counts))
    return _Sized(Trials(motions_a, motions_b, window), counts[0] if counts else 1)


def _is_several(motions: Any) -> bool:
    from . import JointTrajectories, PoseTrajectories

    if isinstance(motions, (PoseTrajectories, JointTrajectories)):
        return True
    if isinstance(motions, np.ndarray):
        return motions.ndim > 1
    if isinstance(motions, (list, tuple)):
        return not (len(motions) == 13 and all(np.isscalar(value) for value in motions))
    return False


@dataclass(frozen=True)
class _SizedEdges:
    edges: Edges
    count: int

    record = EDGE

    def part(self, start: int, end: int) -> Edges:
        whole = self.edges
        return Edges(whole.start[start:end], whole.end[start:end], whole.joints)


@dataclass(frozen=True)
class _Sized:
    trials: Trials
    count: int

    record = RESULT

    def part(self, start: int, end: int) -> Trials:
        whole = self.trials
        cut = [part[start:end] if _is_several(part) else part for part in (whole.motions_a, whole.motions_b)]
        # One motion for all has no length: windows say how many trials there are.
        window = np.broadcast_to(np.asarray((0.0, 1.0) if whole.window is None else whole.window, float), (self.count, 2))
        return _Part(cut[0], cut[1], window[start:end])


class _Part(Trials):
    """Trials that are counted by their windows."""

    def __len__(self) -> int:
        return len(self.window)


class _Pace:
    """How many trials the next chunk should have: enough for half a second, fewer towards the end so that all end together."""

    def __init__(self, workers: int, count: int) -> None:
        self._workers, self._left, self._seconds = workers, count, 0.0

    def next(self) -> int:
        wanted = LEAST_CHUNK if self._seconds == 0.0 else int(CHUNK_SECONDS / self._seconds)
        fair = self._left // (2 * self._workers)
        size = min(max(min(wanted, fair, MOST_CHUNK), LEAST_CHUNK), self._left)
        self._left -= size
        return size

    def learn(self, done: _Done) -> None:
        if len(done.results):
            seconds = max(done.seconds / len(done.results), 1e-9)
            self._seconds = seconds if self._seconds == 0.0 else 0.7 * self._seconds + 0.3 * seconds


def _run(sender: _Sender, trials: _Sized | _SizedEdges, progress: Any) -> tuple[Any, Any]:
    count = trials.count
    results, microseconds = np.zeros(count, trials.record), np.zeros(count)
    pace = _Pace(sender.workers, count)

    def chunks() -> Iterator[Trials | Edges]:
        start = 0
        while start < count:
            end = start + pace.next()
            yield trials.part(start, end)
            start = end

    start = 0
    for done in sender.run(chunks()):
        end = start + len(done.results)
        results[start:end] = done.results
        microseconds[start:end] = 1e6 * done.seconds / max(end - start, 1)
        pace.learn(done)
        _show(progress, end - start, end, count)
        start = end
    return results, microseconds


def _show(progress: Any, more: int, done: int, count: int) -> None:
    if progress is None:
        return
    if hasattr(progress, "update"):
        progress.update(more)
    else:
        progress(done, count)


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m d2m_ccd.ray", description="Runs a trials file over Ray.")
    parser.add_argument("a", help="mesh of body A: a file, a saved tree, or shape:NAME")
    parser.add_argument("b", help="mesh of body B")
    parser.add_argument("--trials", required=True, help="trials, CSV or JSON lines, as of d2m batch")
    parser.add_argument("--out", required=True, help="results, CSV, as of d2m batch; microseconds are the mean of a chunk")
    cluster = parser.add_mutually_exclusive_group()
    cluster.add_argument("--workers", type=int, help="so many worker processes on this machine")
    cluster.add_argument("--address", help="of a cluster that runs: auto, or ray://HOST:PORT")
    parser.add_argument("--tolerance", type=float)
    parser.add_argument("--min-separation", type=float, default=0.0)
    parser.add_argument("--mode", choices=["accurate", "capoeira"], default="accurate")
    parser.add_argument("--budget", type=int, help="node tests a trial")
    solid = parser.add_mutually_exclusive_group()
    solid.add_argument("--solid", action="store_true")
    solid.add_argument("--surface", action="store_true")
    return parser


def main(arguments: list[str] | None = None) -> int:
    """The command; 0: answered, 3: bad input."""
    given = _arguments().parse_args(arguments)
    try:
        if given.workers is not None and given.workers < 1:
            raise InputError(f"--workers {given.workers}: at least one is needed", None, given.workers)
        trials = read_trials(given.trials)
        trees = Tree(given.a), Tree(given.b)
        if given.address:
            ray.init(address=given.address, log_to_driver=False)
        else:
            ray.init(num_cpus=given.workers or os.cpu_count(), include_dashboard=False, log_to_driver=False)
        solid = True if given.solid else False if given.surface else None
        options = {
            "tolerance": given.tolerance,
            "min_separation": given.min_separation,
            "mode": given.mode,
            "node_tests": given.budget,
            "solid": solid,
        }
        sender = _Sender(list(trees), None, 5, options)
        start = time.perf_counter()
        everything = _all_trials(trials.motions_a, trials.motions_b, trials.window)
        results, microseconds = _run(sender, everything, _bar(len(trials)))
        took = time.perf_counter() - start
        with open(given.out, "w", encoding="utf-8", newline="\n") as file:
            write_results(file, results, microseconds)
    except (InputError, OSError) as error:
        print(f"d2m_ccd.ray: {error}", file=sys.stderr)
        return 3
    print(f"{len(results)} trials in {took:.2f} s, {len(results) / took:.0f} a second, {sender.workers} workers", file=sys.stderr)
    return 0


def _bar(count: int) -> Any:
    """A bar of tqdm on a terminal, if it is installed."""
    if not sys.stderr.isatty():
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        return None
    return tqdm(total=count, unit="trial")


if __name__ == "__main__":
    # Under its own name, so that workers import it instead of being sent it.
    from d2m_ccd.ray import main as _main

    sys.exit(_main())
