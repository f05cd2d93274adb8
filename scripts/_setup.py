"""Makes `.venv` and installs Gambol into it, once. Standard library only, on any system.

A stamp in `.venv` remembers what was installed; while it matches, nothing is done.
"""

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
STAMP = VENV / "gambol-installed.txt"
TRIED = VENV / "gambol-tried.txt"  # the Debian packages last asked for; the file's time says when
AGAIN = 24 * 3600.0  # seconds after which they are asked for again
PYTHON = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
LIBRARIES = {
    "libEGL.so.1": ("libegl1", "libegl-mesa0"),
    "libGL.so.1": ("libgl1", "libgl1-mesa-dri", "libglx-mesa0"),
    "libX11.so.6": ("libx11-6",),
    "libXcursor.so.1": ("libxcursor1",),
    "libXi.so.6": ("libxi6",),
    "libXinerama.so.1": ("libxinerama1",),
    "libXrandr.so.2": ("libxrandr2",),
}
"""What drawing and the window load on Linux, and the Debian packages that have it."""


def ready(extra: str = "") -> Path:
    """The environment's Python, with Gambol (and an optional extra) installed in it.

    Exits with one clear line where that can't be done.
    """
    if sys.version_info < (3, 11):  # noqa: UP036, who has an older one is told so
        sys.exit(f"Gambol needs Python 3.11 or newer; this is {platform.python_version()}")
    try:
        _install(extra)
        if platform.system() == "Linux":
            _need_libraries()
    except KeyboardInterrupt:
        sys.exit(130)
    return PYTHON


def run(*arguments: str, folder: Path | None = None) -> int:
    """Run the environment's Python, in the user's folder or another; its exit code."""
    try:
        return subprocess.call([str(PYTHON), *arguments], cwd=folder)
    except KeyboardInterrupt:
        return 130


def _install(extra: str) -> None:
    wanted = _fingerprint()
    done = STAMP.read_text().split() if STAMP.exists() and PYTHON.exists() else []
    extras = set(done[1:]) | ({extra} if extra else set())
    if done[:1] == [wanted] and set(done[1:]) == extras:
        return
    if not _works():
        _make_environment()
    what = ".[" + ",".join(sorted(extras)) + "]" if extras else "."
    print(f"Installing Gambol into {VENV.name} (a few minutes the first time)", flush=True)
    code = subprocess.call([str(PYTHON), "-m", "pip", "install", "--disable-pip-version-check",
                            "--editable", what], cwd=ROOT)
    if code:
        sys.exit("Installing failed; pip's own message is above. Is the network reachable?")
    STAMP.write_text(" ".join([wanted, *sorted(extras)]))


def _fingerprint() -> str:
    """What an installation depends on: the project's declaration, this Python, and where it lies."""
    text = b"".join((ROOT / name).read_bytes() for name in ("pyproject.toml", "setup.py")) + sys.version.encode() + str(ROOT).encode()
    return hashlib.sha256(text).hexdigest()[:32]


def _works() -> bool:
    """Whether there is an environment with a Python as new as needed, and pip in it."""
    check = "import sys, pip; raise SystemExit(sys.version_info < (3, 11))"
    return PYTHON.exists() and subprocess.run([str(PYTHON), "-c", check], capture_output=True).returncode == 0


def _make_environment() -> None:
    print(f"Making {VENV.name}", flush=True)
    try:
        import ensurepip  # noqa: F401  (Debian ships venv without what it needs)
        import venv
    except ImportError:
        version = f"{sys.version_info.major}.{sys.version_info.minor}"
        _apt((f"python{version}-venv",), "Python's venv module is missing")
        return _make_by_command()
    if VENV.exists():
        shutil.rmtree(VENV)
    venv.create(VENV, with_pip=True)


def _make_by_command() -> None:
    """Make the environment in a new process: this one has looked for ensurepip in vain already."""
    if subprocess.call([sys.executable, "-m", "venv", "--clear", str(VENV)]):
        sys.exit("Python's venv module still does not work; see its message above")


def _need_libraries() -> None:
    packages = [package for library, names in LIBRARIES.items() if not _loads(library) for package in names]
    if packages:
        _apt(tuple(packages), "OpenGL's or X11's libraries are missing", optional=True)


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _apt(packages: tuple, why: str, optional: bool = False) -> None:
    """Install Debian packages if this user may; else say what to type, and leave unless `optional`.

    What is optional is tried once a day at most: apt-get takes long to fail without a network.
    """
    command = "apt-get install -y --no-install-recommends " + " ".join(packages)
    if shutil.which("apt-get") is None:
        message = f"{why}. Install what your system calls: {' '.join(packages)}"
    elif os.geteuid() != 0:
        message = f"{why}. Type: sudo apt-get update && sudo {command}"
    elif not (optional and _tried(packages)) and _installed(packages, why):
        return
    else:
        message = f"{why}, and apt-get could not install them. Type: apt-get update && {command}"
    if not optional:
        sys.exit(message)
    print(message, flush=True)


def _installed(packages: tuple, why: str) -> bool:
    print(f"{why}: installing {' '.join(packages)}", flush=True)
    quiet = dict(os.environ, DEBIAN_FRONTEND="noninteractive")
    subprocess.call(["apt-get", "update", "-qq"], env=quiet)
    return subprocess.call(["apt-get", "-qq", "install", "-y", "--no-install-recommends", *packages], env=quiet) == 0


def _tried(packages: tuple) -> bool:
    """Whether these packages were asked for lately; if not, they are noted as asked for now."""
    text = " ".join(packages)
    if TRIED.exists() and TRIED.read_text() == text and time.time() - TRIED.stat().st_mtime < AGAIN:
        return True
    TRIED.write_text(text)
    return False
