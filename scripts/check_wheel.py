"""Checks wheels and source distributions: names, licenses, the files that belong inside, and what they link to.

    python3 scripts/check_wheel.py FILE...

Uses auditwheel and abi3audit, which scripts/wheels installs.
"""

import re
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[1]


def main() -> None:
    """Checks each file, and exits with a message at the first that is not as it should be."""
    for name in sys.argv[1:]:
        path = Path(name)
        if path.suffix == ".whl":
            check_wheel(path)
        else:
            check_source(path)
        print(f"{path.name}: {path.stat().st_size // 1024} KB, as it should be")


def check_wheel(path: Path) -> None:
    """A wheel has the package, its types, its licenses, and one compiled file that links as the wheel's name says."""
    _, version, python, abi, platform = path.stem.split("-")
    wheel = zipfile.ZipFile(path)
    files = {name: wheel.read(name) for name in wheel.namelist()}
    info = f"sweep_and_prune-{version}.dist-info"
    sources = {
        file.relative_to(ROOT / "python/src").as_posix()
        for file in (ROOT / "python/src").rglob("*")
        if file.suffix in {".py", ".pyi", ".typed"}
    }
    check_licenses(path, files, f"{info}/licenses/")
    lacks = sources - set(files)
    check(path, not lacks, f"lacks {sorted(lacks)}")
    compiled = [name for name in files if name.endswith((".so", ".pyd"))]
    check(path, len(compiled) == 1, f"has the compiled files {compiled}")
    rest = [name for name in files if name not in sources and name not in compiled and not name.startswith(info)]
    check(path, not rest, f"also has {rest}")
    check(path, (python, abi) in {("cp39", "abi3"), (abi.rstrip("t"), abi)}, f"is for {python}-{abi}")
    if "linux_" in platform and not platform.startswith("linux"):
        shown = run("auditwheel", "show", path)
        consistent = re.findall(r"(?:many|musl)linux_\d+_\d+_\w+", shown)
        check(path, set(platform.split(".")) & set(consistent), f"is not what auditwheel says: {shown}")
    if abi == "abi3":
        run("abi3audit", "--strict", path)


def check_source(path: Path) -> None:
    """A source distribution has the licenses, a lock file that fits, and all crates that it is built from, but no tests."""
    with tarfile.open(path) as archive, tempfile.TemporaryDirectory() as folder:
        archive.extractall(folder, filter="data")
        manifest = Path(folder, path.name.removesuffix(".tar.gz"), "python/Cargo.toml")
        run("cargo", "metadata", "--locked", "--format-version", "1", "--manifest-path", manifest)
        names = {member.name.split("/", 1)[1]: member for member in archive if member.isfile()}
        files = {name: archive.extractfile(member).read() for name, member in names.items()}
    check_licenses(path, files, "")
    wanted = ["pyproject.toml", "python/Cargo.lock", "python/extension/lib.rs", "core/src/lib.rs", "bindings/src/lib.rs"]
    lacks = [name for name in [*wanted, "src/sweep_and_prune/py.typed"] if name not in files]
    check(path, not lacks, f"lacks {lacks}")
    # They need scenes, documents and programs of the repository.
    tests = [name for name in files if name.startswith("python/tests/")]
    check(path, not tests, f"also has {tests}")
    minimum = re.search(r'^rust-version = "(.*)"', (ROOT / "python/Cargo.toml").read_text(), re.MULTILINE)
    check(path, minimum and f"Rust {minimum[1]} or later" in files["PKG-INFO"].decode(), "does not name its Rust version")


def check_licenses(path: Path, files: "dict[str, bytes]", folder: str) -> None:
    """The license texts are those of the repository, and of the crates that are linked."""
    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        check(path, files.get(folder + name) == (ROOT / name).read_bytes(), f"lacks the text of {name}")
    check(path, b"\nnumpy " in files.get(folder + "LICENSE-DEPENDENCIES", b""), "lacks the license texts of crates")


def check(path: Path, holds: object, message: str) -> None:
    """Exits with a message if something does not hold."""
    if not holds:
        sys.exit(f"{path.name} {message}")


def run(*command: "str | Path") -> str:
    """What a command prints."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]}: {done.stdout}{done.stderr}")
    return done.stdout


main()
