"""Casts that run: progress, interruption, threads, processes."""

import concurrent.futures
import gc
import multiprocessing
import pickle
import signal
import sys
import threading

import numpy as np
import pytest

import cyber_radar
from conftest import DOWN, FACES, at, box, fill, random_poses, same_answers, write_obj


class Hold:
    """A progress callback that waits until its gate is set."""

    def __init__(self):
        self.begun, self.gate = threading.Event(), threading.Event()

    def __call__(self, *_):
        self.begun.set()
        self.gate.wait()

    def wait_for(self, casts: concurrent.futures.Future) -> None:
        """Until it is called, or there is an error that keeps it from that."""
        casts.add_done_callback(lambda _: self.begun.set())
        self.begun.wait()


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


def endless(scene) -> int:
    """Two clouds of segments, through each other, of which no two touch: a search past all takes long."""
    rng = np.random.default_rng(63)
    faces = np.arange(60_000).reshape(-1, 2)[:, [0, 1, 1]]
    clouds = [scene.add_mesh(rng.uniform(-1, 1, (60_000, 3)).astype(np.float32), faces) for _ in range(2)]
    scene.add(clouds[0], np.eye(4))
    return clouds[1]


@pytest.mark.parametrize("mode", ["reference", "contact"])
def test_ctrl_c_ends_a_cast_within_a_query(mode):
    scene = cyber_radar.Scene()
    mesh = endless(scene)
    begun = threading.Event()

    def interrupt():
        begun.wait()
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    # The first chunk is far away from the object.
    poses = np.tile(at([0, 0, 1000]), (65, 1, 1))
    poses[64] = np.eye(4)
    with concurrent.futures.ThreadPoolExecutor() as pool:
        pool.submit(interrupt)
        with pytest.raises(KeyboardInterrupt):
            scene.cast(mesh, poses, [0, 0, 1e-9], mode=mode, progress=lambda *_: begun.set())
    assert scene.cast(mesh, poses[:2], DOWN, mode=mode).status.tolist() == [cyber_radar.Status.CLEAR] * 2


def test_a_handler_of_another_signal_may_end_a_cast_too():
    scene = cyber_radar.Scene()
    mesh = endless(scene)

    def give_up(*_):
        raise TimeoutError("enough")

    before = signal.signal(signal.SIGALRM, give_up)
    try:
        with pytest.raises(TimeoutError, match="enough"):
            signal.setitimer(signal.ITIMER_REAL, 0.1)
            scene.cast(mesh, np.eye(4), [0, 0, 1e-9])
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


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


def test_a_callback_cannot_change_the_scene_that_is_being_cast(boxes):
    scene, mesh = boxes
    for change in (lambda: scene.remove(0), lambda: scene.cast(mesh, None, DOWN)):
        with pytest.raises(RuntimeError, match="cannot change the scene that is being cast, or cast in it"):
            scene.cast(mesh, None, DOWN, mode="reference", progress=lambda *_: change())
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


def until_another_thread_runs_within(call) -> None:
    """Calls until it does: for ever, if calls keep the interpreter's lock, which threads do not take from each other
    here."""
    begin, ran = threading.Lock(), []
    begin.acquire()

    def run():
        begin.acquire()
        ran.append(True)

    other = threading.Thread(target=run)
    other.start()
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e6)
    try:
        begin.release()
        while not ran:
            call()
    finally:
        sys.setswitchinterval(interval)
    other.join()


def test_other_threads_run_while_a_mesh_is_added_deformed_or_read(tmp_path):
    engine = cyber_radar.Scene()._engine
    vertices = np.float32(np.random.default_rng(14).normal(size=(3000, 3)))
    faces = np.arange(3000, dtype=np.uint32).reshape(-1, 3)
    until_another_thread_runs_within(lambda: engine.add_mesh(vertices, faces, np.zeros(3)))
    until_another_thread_runs_within(lambda: engine.set_vertices(0, vertices, np.zeros(3)))
    until_another_thread_runs_within(lambda: cyber_radar._engine.float_vertices(np.float64(vertices), faces))
    write_obj(tmp_path / "a.obj", vertices, faces)
    until_another_thread_runs_within(lambda: cyber_radar._engine.read_mesh(tmp_path / "a.obj", 1.0))
    until_another_thread_runs_within(lambda: cyber_radar._engine.read_assembly(tmp_path / "a.obj", 1.0))


def test_a_callback_may_look_at_the_scene_that_is_being_cast(boxes):
    scene, mesh = boxes
    seen = []

    def look(*_):
        seen.append((len(scene), scene.meshes, scene.device_names, len(scene.objects().ids), len(scene.mesh(mesh)[1])))

    scene.cast(mesh, None, DOWN, mode="reference", progress=look)
    assert seen == [(200, [mesh], [], 200, 12)]


def test_what_other_threads_ask_and_change_waits_for_a_cast(boxes):
    scene, mesh = boxes
    poses, displacements = many(3000)
    expected = scene.cast(mesh, poses, displacements, mode="reference")
    hold, asked = Hold(), []
    with concurrent.futures.ThreadPoolExecutor(3) as threads:
        casts = threads.submit(scene.cast, mesh, poses, displacements, progress=hold)
        hold.wait_for(casts)
        names = threads.submit(lambda: asked.append(scene.device_names))
        moved = threads.submit(scene.set_transforms, np.arange(200), at([0, 0, 99]))
        early = bool(asked) or names.done() or moved.done()
        hold.gate.set()
        assert same_answers(casts.result(), expected, but=("tier",))
        names.result(), moved.result()
    assert not early
    assert asked == [scene.device_names] and len(asked[0]) == 1
    assert not scene.cast(mesh, poses, displacements, mode="reference").touches.any()


def test_threads_may_share_a_scene(boxes):
    scene, mesh = boxes
    poses, displacements = many(600)
    expected = scene.cast(mesh, poses, displacements)
    with concurrent.futures.ThreadPoolExecutor(4) as threads:
        parts = list(
            threads.map(lambda i: scene.cast(mesh, poses[i::4], displacements[i::4], hits=2).t, range(4))
        )
    for i, part in enumerate(parts):
        assert (part == expected.t[i::4]).all()


def _distances(scene, mesh, poses, mode):
    return scene.cast(mesh, poses, DOWN, mode=mode).t


# Python 3.12 and later warn of every fork of a process that has several threads.
many_threads = pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")


@many_threads
@pytest.mark.parametrize("start", ["spawn", "fork"])
@pytest.mark.parametrize("mode", ["reference", "contact"])
def test_other_processes_answer_with_the_pickled_scene(boxes, start, mode):
    scene, mesh = boxes
    poses, _ = many(40)
    expected = scene.cast(mesh, poses, DOWN, mode=mode).t  # with what runs it open before a fork
    with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context(start)) as processes:
        parts = [processes.submit(_distances, scene, mesh, poses[i::2], mode) for i in range(2)]
        for i, part in enumerate(parts):
            assert (part.result() == expected[i::2]).all()


def _cast_inherited(queue):
    queue.put(_distances(*_inherited))


@many_threads
def test_a_forked_process_opens_devices_of_its_own(boxes):
    global _inherited
    scene, mesh = boxes
    poses, _ = many(40)
    expected = scene.cast(mesh, poses, DOWN)
    _inherited = (scene, mesh, poses, "contact")
    context = multiprocessing.get_context("fork")
    queue = context.SimpleQueue()
    process = context.Process(target=_cast_inherited, args=(queue,))
    process.start()
    assert (queue.get() == expected.t).all()
    process.join()
    assert process.exitcode == 0


def _try_inherited(queue):
    try:
        queue.put(str(_distances(*_inherited)))
    except RuntimeError as error:
        queue.put(str(error))


@many_threads
def test_a_process_forked_while_another_thread_casts_is_told_instead_of_waiting_for_ever(boxes):
    global _inherited
    scene, mesh = boxes
    poses, displacements = many(3000)
    hold = Hold()
    with concurrent.futures.ThreadPoolExecutor(1) as threads:
        casts = threads.submit(scene.cast, mesh, poses, displacements, mode="reference", progress=hold)
        hold.wait_for(casts)
        _inherited = (scene, mesh, poses, "reference")
        context = multiprocessing.get_context("fork")
        queue = context.SimpleQueue()
        process = context.Process(target=_try_inherited, args=(queue,))
        process.start()
        told = queue.get()
        process.join()
        hold.gate.set()
        assert "another thread was using this scene when the process forked" in told
        assert casts.result().shape == (3000,)
    assert scene.cast(mesh, poses, displacements, mode="reference").shape == (3000,)


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
    assert held == 120_000_000
    assert _memory() - before < held + 64e6
    assert casts.t.shape == (1_000_000,) and not casts.touches.any()
    assert pickle.loads(pickle.dumps(scene.cast(mesh, far[0], DOWN, mode="reference"))).t == np.inf
