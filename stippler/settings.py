"""The person's settings folder, and small JSON documents in it."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path
from typing import Any

from platformdirs import user_config_path

from stippler.atomic_write import replacing
from stippler.errors import OutputError, StipplerError


def settings_folder() -> Path:
    """Return where settings are kept; ``STIPPLER_CONFIG_DIR`` moves it."""
    base = os.environ.get("STIPPLER_CONFIG_DIR")
    return Path(base) if base else user_config_path("stippler")


def read_document(path: Path) -> tuple[dict[str, Any], str]:
    """Return a JSON object, and what was wrong with its file, if anything.

    A file that holds none is put aside under another name, so that it is not written over.
    """
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        if isinstance(document, dict):
            return document, ""
        why = "it holds no object"
    except FileNotFoundError:
        return {}, ""
    except OSError as error:
        return {}, f"{path}: cannot be read ({error.strerror}); defaults are used"
    except (ValueError, RecursionError) as error:  # broken JSON, or no UTF-8; or a pit of brackets
        why = str(error)
    aside = put_aside(path)
    return {}, f"{path}: is broken ({why}); defaults are used, and it is kept as {aside}"


def put_aside(path: Path) -> str:
    """Rename a file that is of no use; return its new name."""
    aside = path.with_name(f"{path.stem}.broken{path.suffix}")
    with contextlib.suppress(OSError):
        os.replace(path, aside)
        return aside.name
    return path.name


def write_document(path: Path, document: dict[str, Any]) -> None:
    """Write a JSON object, whole or not at all.

    Raises
    ------
    StipplerError
        If it cannot be written.
    """
    write_text(path, json.dumps(document, indent=1))


def write_text(path: Path, text: str) -> None:
    """Write a settings file, whole or not at all.

    Raises
    ------
    StipplerError
        If it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as stream:
            stream.write(text.encode())
    except OSError as error:
        why = error.what if isinstance(error, OutputError) else error.strerror
        raise StipplerError(f"settings cannot be kept ({why})", path, "check the folder") from error
