"""Casts that run: progress, interruption, threads, processes."""

import concurrent.futures
import gc
import multiprocessing
import pickle
import signal
import threading

import numpy as np
import pytest

import cyber_radar
from conftest import DOWN, FACES, at, box, fill, random_poses, same_answers


class Hold:
    """A progress callback that waits until its gate is set."""

    def __init__(self):
        self.begun, self.gate = threading.Event(), threading.Event()

    def __call__(self, *_):
        self.begun.set()
        self.gate.wait()


def many(count: int):
    rng = np.random.default_rng(10)
    return random_poses(rng, count, 20), rng.normal(size=(count, 3)) * 5


def test_progress_is_reported_and_grows_to_the_end(boxes):
    scene, mesh = boxes
    poses, displacements = many(5000)
    seen = []
    scene.cast(mesh, poses, displacements, mode="reference", progress=lambda *numbers: seen.append(numbers))
    done = [numbers[0] for numbers in seen]
    assert len(done) > 1 and done == sorted(set(done)) and seen[-1] == (5000, 5000)


def test_ctrl_c_ends_a_cast(boxes):
    scene, mesh = boxes
    poses, displacements = many(5000)
    seen = []

    def interrupt(done, total):
        seen.append(done)
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        scene.cast(mesh, poses, displacements, mode="reference", progress=interrupt)
    assert len(seen) == 1 and seen[0] < 5000
    assert scene.cast(mesh, poses[:9], DOWN, mode="reference").shape == (9,)


def test_what_progress_raises_ends_the_cast_with_some_of_out_written(boxes):
    scene, mesh = boxes
    poses, displacements = many(5000)
    expected = scene.cast(mesh, poses, displacements, mode="reference")
    out = cyber_radar.Casts.empty((5000,))
    out.object[:] = -7
    done = 0

    def stop(now, total):
        nonlocal done
        done = now
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        scene.cast(mesh, poses, displacements, mode="contact", out=out, progress=stop)
    assert (out.object[:done] == expected.object[:done]).all() and (out.object[done:] == -7).all()


def test_a_callback_cannot_use_the_scene_that_is_being_cast(boxes):
    scene, mesh = boxes
    with pytest.raises(RuntimeError, match="cannot use the scene that is being cast"):
        scene.cast(mesh, None, DOWN, mode="reference", progress=lambda *_: scene.remove(0))
    assert len(scene) == 200


def test_other_threads_run_during_a_cast(boxes):
    scene, mesh = boxes
    poses, displacements = many(2000)
    reached = threading.Event()
    other = threading.Thread(target=reached.set)
    # Started before the first chunk and waited for between two: deadlocks if a cast kept the interpreter's lock.
    other.start()
    scene.cast(mesh, poses, displacements, mode="reference", progress=lambda *_: reached.wait())
    other.join()


def test_cast_async_gives_the_same_answers_and_changes_wait_for_it(boxes):
    scene, mesh = boxes
    poses, displacements = many(3000)
    expected = scene.cast(mesh, poses, displacements, mode="reference")
    given, hold = poses.copy(), Hold()
    first = scene.cast_async(mesh, given, displacements, mode="reference", progress=hold)
    hold.begun.wait()
    second = scene.cast_async(mesh, given, displacements, mode="reference")
    given[:] = 0  # the arguments were copied
    assert not first.done() and not second.done()
    mover = threading.Thread(target=lambda: scene.set_transforms(np.arange(200), at([0, 0, 99])))
    mover.start()
    hold.gate.set()
    assert same_answers(first.result(), expected) and same_answers(second.result(), expected)
    mover.join()
    assert first.done() and first.progress == (3000, 3000)
    assert not scene.cast(mesh, poses, displacements, mode="reference").touches.any()


def test_a_handle_cancels_what_runs_and_what_waits(boxes):
    scene, mesh = boxes
    poses, displacements = many(3000)
    hold = Hold()
    running = scene.cast_async(mesh, poses, displacements, mode="reference", progress=hold)
    hold.begun.wait()
    waiting = scene.cast_async(mesh, poses, displacements, mode="reference")
    with pytest.raises(concurrent.futures.TimeoutError):
        running.result(timeout=0)
    waiting.cancel()
    running.cancel()
    hold.gate.set()
    for handle in (running, waiting):
        with pytest.raises(concurrent.futures.CancelledError):
            handle.result()
    assert running.progress[0] < 3000
    with pytest.raises(ValueError, match="poses"):
        scene.cast_async(mesh, np.eye(3), displacements)


def test_threads_may_share_a_scene(boxes):
    scene, mesh = boxes
    poses, displacements = many(600)
    expected = scene.cast(mesh, poses, displacements)
    with concurrent.futures.ThreadPoolExecutor(4) as threads:
        parts = list(
            threads.map(lambda i: scene.cast(mesh, poses[i::4], displacements[i::4], hits=2).distance, range(4))
        )
    for i, part in enumerate(parts):
        assert (part == expected.distance[i::4]).all()


def _distances(scene, mesh, poses, mode):
    return scene.cast(mesh, poses, DOWN, mode=mode).distance


@pytest.mark.parametrize("start", ["spawn", "fork"])
@pytest.mark.parametrize("mode", ["reference", "contact"])
def test_other_processes_answer_with_the_pickled_scene(boxes, start, mode):
    scene, mesh = boxes
    poses, _ = many(40)
    expected = scene.cast(mesh, poses, DOWN, mode=mode).distance  # with what runs it open before a fork
    with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context(start)) as processes:
        parts = [processes.submit(_distances, scene, mesh, poses[i::2], mode) for i in range(2)]
        for i, part in enumerate(parts):
            assert (part.result() == expected[i::2]).all()


def _cast_inherited(queue):
    queue.put(_distances(*_inherited))


def test_a_forked_process_opens_devices_of_its_own(boxes):
    global _inherited
    scene, mesh = boxes
    poses, _ = many(40)
    expected = scene.cast(mesh, poses, DOWN)
    scene.cast_async(mesh, poses, DOWN).result()
    _inherited = (scene, mesh, poses, "contact")
    context = multiprocessing.get_context("fork")
    queue = context.SimpleQueue()
    process = context.Process(target=_cast_inherited, args=(queue,))
    process.start()
    assert (queue.get() == expected.distance).all()
    process.join()
    assert process.exitcode == 0


def _memory() -> int:
    """Resident bytes of this process."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096


def test_ten_thousand_scenes_leave_no_memory_behind():
    vertices, poses = box(1, 1, 1), at([[0, 0, 3], [5, 0, 3], [np.nan, 0, 0]])

    def use(i):
        scene = cyber_radar.Scene(threads=1)
        mesh = scene.add_mesh(vertices, FACES)
        scene.add(mesh, at([0, 0, -3]))
        count = 3 if i % 10 == 0 else 2
        casts = scene.cast(mesh, poses[:count], DOWN, mode="reference", hits=2, skip_overlapping=True)
        assert casts.object.tolist() == [0, -1, -1][:count]
        if i % 10 == 0:
            with pytest.raises(ValueError):
                scene.cast(mesh, poses, 0)

    for i in range(500):
        use(i)
    gc.collect()
    before = _memory()
    for i in range(10000):
        use(i)
    gc.collect()
    # A lost kilobyte each would be 10 MB.
    assert _memory() - before < 4e6


def test_a_million_casts_need_no_more_than_their_arrays():
    scene = cyber_radar.Scene()
    mesh = fill(scene)
    far = np.broadcast_to(at([1e6, 0, 0]), (1_000_000, 4, 4))
    scene.cast(mesh, far[:1000], DOWN, mode="reference")
    before = _memory()
    casts = scene.cast(mesh, far, DOWN, mode="reference")
    held = sum(getattr(casts, name).nbytes for name in vars(casts) if isinstance(getattr(casts, name), np.ndarray))
    assert held == 109_000_000
    assert _memory() - before < held + 64e6
    assert casts.distance.shape == (1_000_000,) and not casts.touches.any()
    assert pickle.loads(pickle.dumps(scene.cast(mesh, far[0], DOWN, mode="reference"))).distance == np.inf
