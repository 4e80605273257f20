"""Builds by maturin, and makes a source distribution that builds by itself.

maturin packs this package and the crates that it needs, but of the command's workspace, from which those take version and
edition, only the manifest: one of a package without its sources, which cargo refuses. Here it becomes that of the workspace
alone. The commit, which git knows no more there, goes along in a file that ``provenance`` reads.
"""

from __future__ import annotations

import gzip
import re
import subprocess
import tarfile
import tempfile
from pathlib import Path

import maturin
from maturin import (
    build_editable,
    build_wheel,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

ROOT = Path(__file__).resolve().parents[1]

#: Tables of a manifest that are the workspace's; the others are the command's.
OF_WORKSPACE = ("workspace", "profile")


def build_sdist(sdist_directory: str, config_settings: dict[str, object] | None = None) -> str:
    """Makes the archive in a folder; gives its name."""
    name: str = maturin.build_sdist(sdist_directory, config_settings)
    archive = Path(sdist_directory) / name
    with tempfile.TemporaryDirectory() as place:
        with tarfile.open(archive) as packed:
            packed.extractall(place, filter="data")
        (tree,) = Path(place).iterdir()
        _complete(tree)
        # Without the time and the user of the packing: the same files are the same archive.
        with gzip.GzipFile(archive, "wb", mtime=0) as file, tarfile.open(fileobj=file, mode="w") as packed:
            for path in sorted(tree.rglob("*")):
                if path.is_file():
                    packed.add(path, f"{tree.name}/{path.relative_to(tree)}", filter=_nobodys)
    return name


def _nobodys(entry: tarfile.TarInfo) -> tarfile.TarInfo:
    entry.uid = entry.gid = entry.mtime = 0
    entry.uname = entry.gname = ""
    return entry


def _complete(tree: Path) -> None:
    manifest = tree / "Cargo.toml"
    manifest.write_text(_of_workspace(manifest.read_text(), tree))
    settings = tree / "pyproject.toml"
    own = r'(#.*\n)?build-backend = "backend"\nbackend-path = .*\n'
    text, changed = re.subn(own, 'build-backend = "maturin"\n', settings.read_text())
    if not changed:
        raise RuntimeError(f"{settings.name}: it names no backend of its own: python/backend.py is out of date")
    settings.write_text(text)
    for licence in ("LICENSE-APACHE", "LICENSE-MIT"):
        (tree / licence).write_bytes((ROOT / licence).read_bytes())
    # A copy that git does not track may lie inside somebody else's repository.
    is_tracked = _git("ls-files", "--error-unmatch", "--", "python/backend.py")
    if is_tracked and (commit := _git("rev-parse", "--short=12", "HEAD")):
        # Whether somebody changes the files after they were unpacked, nobody knows.
        state = "true" if _git("status", "--porcelain", "--untracked-files=no", "--", *_sources(tree)) else "unknown"
        (tree / "COMMIT").write_text(f"{commit} {state}\n")


def _sources(tree: Path) -> list[str]:
    """What is in the archive and in the repository."""
    return [path.name for path in tree.iterdir() if (ROOT / path.name).exists()]


def _git(*arguments: str) -> str:
    """What git says of the repository; nothing where there is none."""
    try:
        said = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return said.stdout.strip()


def _of_workspace(manifest: str, tree: Path) -> str:
    """The tables of the workspace, with those members that are there."""
    kept = []
    for table in re.split(r"(?m)^(?=\[)", manifest):
        header = re.match(r"\[+([\w-]+)", table)
        if header and header[1] in OF_WORKSPACE:
            kept.append(table)
    text = "".join(kept)
    found = re.search(r"(?m)^members = \[(.*)\]$", text)
    if not found:
        raise RuntimeError("Cargo.toml: members of the workspace are not in one line: python/backend.py is out of date")
    members = [member for member in re.findall(r'"([^"]*)"', found[1]) if (tree / member / "Cargo.toml").is_file()]
    listed = ", ".join(f'"{member}"' for member in members)
    return text[: found.start()] + f"members = [{listed}]" + text[found.end() :]
