"""What is written about the package is true: its examples run as written, its types hold."""

import re
import subprocess
import sys
from pathlib import Path


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)


def test_the_examples_of_the_readme_run_as_written(root, desk):
    found = blocks(root / "python" / "README.md", "python")
    assert len(found) == 2
    for block in found:
        done = subprocess.run([sys.executable, "-c", block], cwd=desk, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert (desk / "runs" / "first" / "front.csv").exists()


def test_the_types_hold(root):
    """Of the package, of its examples, and that a wrong use is found."""
    package = [str(root / "python" / "grn")]
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary"]
    done = subprocess.run([*command, *package], capture_output=True, text=True, cwd=root / "python")
    assert done.returncode == 0, done.stdout
    right = "\n".join(block for block in blocks(root / "python" / "README.md", "python"))
    for source, code in ((right, 0), ("import grn\ngrn.Robot(1).tick(heading='north')", 1)):
        done = subprocess.run([*command, "-c", source], capture_output=True, text=True, cwd=root / "python")
        assert done.returncode == code, done.stdout
