"""Virtual environments with the programs measured beside qrt, from PyPI at pinned versions."""

import os
import pathlib
import subprocess
import sys
import venv

HERE = pathlib.Path(__file__).resolve().parent


def inside(folder, requirements):
    """Goes on in the virtual environment `folder`, which is made of `requirements` if it is not there."""
    folder = pathlib.Path(folder).resolve()
    if pathlib.Path(sys.prefix).resolve() == folder:
        return
    python = folder / "bin" / "python"
    requirements = HERE / requirements
    installed = folder / "installed.txt"
    if folder.exists() and any(folder.iterdir()) and not (folder / "pyvenv.cfg").exists():
        sys.exit(f"{folder} holds something else than a virtual environment; name another folder")
    if not installed.exists() or installed.read_text() != requirements.read_text():
        venv.create(folder, with_pip=True, clear=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, "-r", requirements], check=True, stdout=sys.stderr)
        installed.write_text(requirements.read_text())
    script = pathlib.Path(sys.argv[0]).resolve()
    os.execv(python, [str(python), str(script), *sys.argv[1:]])
