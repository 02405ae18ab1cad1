"""Several devices. ctest runs this with two."""

import numpy as np

import cyber_radar
from conftest import DOWN, at, fill, random_poses, same_answers
from cyber_radar import Status


def test_devices_share_the_casts_and_see_every_change():
    assert len(cyber_radar.devices()) == 2
    rng = np.random.default_rng(11)
    poses, displacements = random_poses(rng, 900, 20), rng.normal(size=(900, 3)) * 5
    for device in ("all", [1, 0]):
        pool = cyber_radar.Scene(device=device, cpu_batch=0)
        mesh = fill(pool)
        for move in ([0, 0, 0], [1, 2, 3]):
            pool.set_transforms(np.arange(50), at(np.arange(150).reshape(50, 3) % 7 + move))
            casts = pool.cast(mesh, poses, displacements, hits=2)
            reference = pool.cast(mesh, poses, displacements, hits=2, mode="reference")
            assert same_answers(casts, reference, but=("tier",))
            assert same_answers(casts.hits, reference.hits, but=("tier",))
        assert len(pool.device_names) == 2
        poses[5] = np.nan
        assert pool.cast(mesh, poses, displacements).status[5] == Status.INVALID
        poses[5] = np.eye(4)
        pool.remove(np.arange(200))
        assert not pool.cast(mesh, poses, DOWN).touches.any()
