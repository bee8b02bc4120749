"""Pictures by clusters: workers may die, and the picture is the same."""

import os
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy
import pytest

import qrt


def test_dask_renders_the_picture_while_two_of_four_workers_are_killed(box, tmp_path):
    distributed = pytest.importorskip("distributed")
    slow = qrt.parse(box.to_yaml(), {"sampling.path_bits": 16})
    portions = 48
    options = {"n_workers": 4, "threads_per_worker": 1, "processes": True}
    with distributed.LocalCluster(**options, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            workers = client.run(os.getpid)
            begun = threading.Event()
            finished = [0]

            def told(done, total):
                assert total == portions
                finished[0] = done
                if done:
                    begun.set()

            # The number of portions that were finished when each worker was killed.
            killed = []

            def kill():
                begun.wait(120)
                for process in list(workers.values())[:2]:
                    os.kill(process, signal.SIGKILL)
                    killed.append(finished[0])
                    time.sleep(0.2)

            killer = threading.Thread(target=kill)
            killer.start()
            picture = qrt.distributed.render(
                slow, client, portions=portions, estimator="exact", progress=told
            )
            killer.join()
    assert len(killed) == 2 and all(0 < done < portions for done in killed), killed
    assert finished[0] == portions
    for made, name in ((picture, "dask.exr"), (slow.render(estimator="exact"), "own.exr")):
        made.save(tmp_path / name)
    assert (tmp_path / "dask.exr").read_bytes() == (tmp_path / "own.exr").read_bytes()


def test_submitit_renders_the_picture(box, tmp_path):
    submitit = pytest.importorskip("submitit")
    executor = submitit.LocalExecutor(folder=tmp_path)
    executor.update_parameters(timeout_min=5)
    picture = qrt.distributed.render(box, executor, portions=3, estimator="exact")
    assert numpy.array_equal(picture.pixels, box.render(estimator="exact").pixels)


SCRIPT = """
    import sys
    from mpi4py.futures import MPIPoolExecutor
    import qrt

    if __name__ == "__main__":
        scene = qrt.load(sys.argv[1])
        with MPIPoolExecutor() as pool:
            assert pool.num_workers == 2
            picture = qrt.distributed.render(scene, pool, portions=6, estimator="exact")
        picture.save(sys.argv[2])
"""


def test_mpirun_renders_the_picture(box, box_file, tmp_path):
    pytest.importorskip("mpi4py")
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("there is no mpirun: Debian's is in openmpi-bin")
    script = tmp_path / "cluster.py"
    script.write_text(textwrap.dedent(SCRIPT))
    words = [mpirun, "-n", "3", "--oversubscribe"]
    if os.geteuid() == 0:
        words.append("--allow-run-as-root")
    words += [sys.executable, "-m", "mpi4py.futures", script, box_file, tmp_path / "mpi.exr"]
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    box.render(estimator="exact").save(tmp_path / "own.exr")
    assert (tmp_path / "mpi.exr").read_bytes() == (tmp_path / "own.exr").read_bytes()
