"""Other people's CMake projects take Edgeline in by add_subdirectory or FetchContent, all or firmware/ alone: it
builds without a warning under their flags, draws the simulator's picture, and leaves nothing else in their build.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from needs import need_simulator, need_tool
from packages_tools import HERE, REPOSITORY, TRIANGLE_VIEW, run, triangle_mesh, tried


@pytest.fixture(scope="session")
def expected_crc(tmp_path_factory: pytest.TempPathFactory) -> str:
    mesh = triangle_mesh(tmp_path_factory.mktemp("triangle"))
    output = run(need_simulator(), "render", "--mesh", mesh, *TRIANGLE_VIEW, "--size", "320x240", "--crc")
    return output.decode().strip()


@pytest.fixture(scope="session")
def clone(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The address of a Git repository that holds what would be committed now."""
    need_tool("git", "git")
    folder = tmp_path_factory.mktemp("repository")
    listing = run("git", "ls-files", "-z", "-co", "--exclude-standard", "CMakeLists.txt", "firmware", cwd=REPOSITORY)
    for name in set(listing.decode().split("\0")) - {""}:
        if (REPOSITORY / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(REPOSITORY / name, folder / name)
    git = ["git", "-c", "user.name=test", "-c", "user.email=test@localhost", "-c", "init.defaultBranch=trunk"]
    for arguments in (["init", "-q"], ["add", "-A", "-f"], ["commit", "-q", "-m", "state"]):
        run(*git, *arguments, cwd=folder)
    return folder.as_uri()


def configure(build: Path, way: str, place: str, subfolder: str = "") -> subprocess.CompletedProcess[bytes]:
    definitions = [f"-DWAY={way}", f"-DEDGELINE_DIR={place}"]
    if way == "FetchContent":
        definitions.append(f"-DSUBFOLDER={subfolder}")
    return tried(need_tool("cmake", "cmake"), "-S", HERE / "cmake_consumer", "-B", build, *definitions)


def build_and_run(build: Path, configured: subprocess.CompletedProcess[bytes]) -> str:
    assert configured.returncode == 0, configured.stderr.decode()[-3000:]
    assert b"Warning" not in configured.stderr, configured.stderr.decode()[-3000:]
    run("cmake", "--build", build, "--parallel", "2")
    return run(build / "consumer").decode().strip()


@pytest.mark.parametrize("folder", ["", "firmware"])
def test_by_add_subdirectory(folder: str, expected_crc: str, tmp_path: Path) -> None:
    assert build_and_run(tmp_path, configure(tmp_path, "add_subdirectory", str(REPOSITORY / folder))) == expected_crc
    [mine] = [
        entry["command"]
        for entry in json.loads((tmp_path / "compile_commands.json").read_text(encoding="utf-8"))
        if entry["file"].endswith("cmake_consumer/main.c")
    ]
    assert "-ffreestanding" not in mine and " -O" not in mine, f"flags of the library's own: {mine}"
    assert not list(tmp_path.rglob("*scenes*.o")), "the demo's scenes were compiled, too"


@pytest.mark.parametrize("subfolder", ["", "firmware"])
def test_by_fetch_content(subfolder: str, clone: str, expected_crc: str, tmp_path: Path) -> None:
    assert build_and_run(tmp_path, configure(tmp_path, "FetchContent", clone, subfolder)) == expected_crc


@pytest.mark.parametrize(
    ("leak", "message"),
    [
        ("add_custom_target(stray)", "stray"),
        ('set(STRAY ON CACHE BOOL "")', "STRAY"),
        ("set(CMAKE_BUILD_TYPE Debug PARENT_SCOPE)", "CMAKE_BUILD_TYPE"),
    ],
)
def test_a_leak_would_be_seen(leak: str, message: str, tmp_path: Path) -> None:
    """The proof that the consumer looks."""
    library = tmp_path / "library"
    library.mkdir()
    (library / "CMakeLists.txt").write_text(f"add_library(edgeline INTERFACE)\n{leak}\n", encoding="utf-8")
    done = configure(tmp_path / "build", "add_subdirectory", str(library))
    assert done.returncode != 0
    assert message in done.stderr.decode()
