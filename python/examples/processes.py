"""A picture by processes of this machine."""

import concurrent.futures
import multiprocessing
import sys

import qrt

if __name__ == "__main__":
    scene = qrt.load(sys.argv[1])
    spawn = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(mp_context=spawn) as pool:
        picture = qrt.distributed.render(scene, pool, seed=1)
    picture.save("picture.png")
