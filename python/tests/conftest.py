import os
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture
def model(root: Path) -> Path:
    return root / "models" / "nand-xnor.grn"


@pytest.fixture
def channel(root: Path) -> Path:
    return root / "scenarios" / "channel.toml"


@pytest.fixture(scope="session")
def grn_command() -> str:
    """The command line that was built beside the package."""
    command = os.environ.get("GRN_COMMAND", str(ROOT / "target" / "debug" / "grn"))
    assert Path(command).exists(), f"{command} is missing: cargo build --package host-evolver, or set GRN_COMMAND"
    return command


@pytest.fixture
def desk(root: Path, tmp_path: Path) -> Path:
    """A folder in which the repository's paths lead to its files."""
    for name in ("models", "scenarios", "examples"):
        shutil.copytree(root / name, tmp_path / name)
    return tmp_path
