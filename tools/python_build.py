"""Builds the wheel for pip (PEP 517), with CMake and the standard library alone: `pip install .`, `pip wheel .`

The distribution's Python shares the build folder of `./run` and `./test`, build/release, where there is one, so that
only the module itself is compiled; otherwise everything it needs is built in a folder of build/ named after the wheel's
tag. WUNDERLICH_BUILD_FOLDER names another configured folder. What is built runs on machines like this one;
WUNDERLICH_NATIVE=OFF makes a wheel that runs on any of the same kind.
"""

import base64
import hashlib
import os
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def setting(cache, name):
    """The value of a variable in a CMakeCache.txt, or None."""
    for line in cache.read_text(encoding="utf-8").splitlines() if cache.exists() else []:
        if line.startswith(name + ":"):
            return line.partition("=")[2]
    return None


def build_module():
    """Compiles what is not up to date; the folder of the importable package."""
    python = os.path.realpath(sys.executable)  # not a virtual environment's, which may be gone tomorrow
    portable = os.environ.get("WUNDERLICH_NATIVE", "ON").upper() == "OFF"
    distribution = python == os.path.realpath("/usr/bin/python3")
    release = ROOT / "build" / "release"
    if "WUNDERLICH_BUILD_FOLDER" in os.environ:
        preset, folder = None, Path(os.environ["WUNDERLICH_BUILD_FOLDER"]).resolve()
    elif distribution and not portable and (release / "CMakeCache.txt").exists():
        preset, folder = "release", release
    else:
        preset, folder = "python", ROOT / "build" / f"{tag()}{'-portable' if portable else ''}"
    cache = folder / "CMakeCache.txt"
    if setting(cache, "WUNDERLICH_PYTHON") != "ON" or os.path.realpath(setting(cache, "_Python_EXECUTABLE") or "") != python:
        how = ["--preset", preset] if preset else ["-S", str(ROOT)]
        more = ["-DWUNDERLICH_NATIVE=OFF"] if portable else []
        subprocess.run(["cmake", *how, "-B", str(folder), "-DWUNDERLICH_PYTHON=ON", f"-DPython_EXECUTABLE={python}", *more],
                       cwd=ROOT, check=True)
    subprocess.run(["cmake", "--build", str(folder), "--target", "_wunderlich"], cwd=ROOT, check=True)
    return folder / "python" / "wunderlich"


def tag():
    """Of the wheel: one Python, one platform."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def metadata():
    about = project()
    lines = ["Metadata-Version: 2.1", f"Name: {about['name']}", f"Version: {about['version']}", f"Summary: {about['description']}",
             "License: MIT", f"Requires-Python: {about['requires-python']}"]
    lines += [f"Requires-Dist: {needed}" for needed in about["dependencies"]]
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", (ROOT / about["readme"]).read_text(encoding="utf-8")])


def stem():
    """Of the files' names: name-version."""
    about = project()
    return f"{about['name']}-{about['version']}"


def describe():
    """The files of the .dist-info folder that do not depend on what is built."""
    wheel = f"Wheel-Version: 1.0\nGenerator: {stem()}\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    return {"METADATA": metadata().encode(), "LICENSE": (ROOT / "LICENSE").read_bytes(), "WHEEL": wheel.encode()}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """So that pip hears what is needed before anything is compiled."""
    folder = Path(metadata_directory) / f"{stem()}.dist-info"
    folder.mkdir()
    for name, data in describe().items():
        (folder / name).write_bytes(data)
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = build_module()
    info = f"{stem()}.dist-info"
    files = {f"wunderlich/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
    files |= {f"{info}/{name}": data for name, data in describe().items()}
    record = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}"
              for name, data in files.items()]
    files[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    wheel = f"{stem()}-{tag()}.whl"
    with zipfile.ZipFile(Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    """Every file under version control, and PKG-INFO."""
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()
    info = Path(sdist_directory) / "PKG-INFO"
    info.write_text(metadata(), encoding="utf-8")
    with tarfile.open(Path(sdist_directory) / f"{stem()}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        archive.add(info, f"{stem()}/PKG-INFO")
        for name in names:
            archive.add(ROOT / name, f"{stem()}/{name}")
    info.unlink()
    return f"{stem()}.tar.gz"
