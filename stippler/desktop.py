"""An entry for the menus of Linux desktops: program, icon, and the drawings' own kind of file."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from platformdirs import user_data_path

from stippler.atomic_write import replacing
from stippler.errors import OutputError, StipplerError
from stippler.resources import assets

APP_ID = "stippler"
"""Also what windows call themselves, so that a desktop finds their icon."""

_OPENED = (
    "application/x-stipple", "image/png", "image/jpeg", "image/tiff", "image/webp", "image/bmp",
    "image/gif", "image/jp2", "image/heif", "image/heic", "image/avif",
)  # fmt: skip
_REFRESH = (
    ("update-desktop-database", "applications"),
    ("update-mime-database", "mime"),
    ("gtk-update-icon-cache", "icons/hicolor"),
)


def install() -> Iterator[Path]:
    """Put the entry, the icon and the kind of file into the person's data folder; yield each.

    Raises
    ------
    StipplerError
        Where there are no such entries, or the folder cannot be written.
    """
    if sys.platform != "linux":
        raise StipplerError("is for Linux", "--install-desktop", "see docs/installing.md")
    base = _data_folder()
    for name, content in _files().items():
        path = base / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(
                f"cannot be made ({error.strerror})", path.parent, "set XDG_DATA_HOME"
            ) from error
        with replacing(path) as stream:
            stream.write(content)
        yield path
    for command, folder in _REFRESH:
        if shutil.which(command):
            subprocess.run(
                [command, base / folder],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=False,
            )


def _data_folder() -> Path:
    named = os.environ.get("XDG_DATA_HOME", "")
    return Path(named) if Path(named).is_absolute() else user_data_path()


def _files() -> dict[str, bytes]:
    return {
        f"applications/{APP_ID}.desktop": _entry(_program()).encode(),
        f"icons/hicolor/scalable/apps/{APP_ID}.svg": (assets() / "icons/stippler.svg").read_bytes(),
        f"mime/packages/{APP_ID}.xml": _KIND.encode(),
    }


def _program() -> list[str]:
    """Return how this very installation is started."""
    beside = Path(sys.executable).with_name("stippler")
    return [str(beside)] if beside.is_file() else [sys.executable, "-m", "stippler"]


def _entry(program: list[str]) -> str:
    """Return the entry, by the Desktop Entry Specification."""
    return "\n".join(
        [
            "[Desktop Entry]",
            "Type=Application",
            "Version=1.0",
            "Name=Stippler",
            "GenericName=Stipple drawing editor",
            "Comment=Draw pictures in tens of thousands of ink dots",
            f"Exec={' '.join(map(_quoted, program))} edit %f",
            f"Icon={APP_ID}",
            "Terminal=false",
            "Categories=Graphics;2DGraphics;RasterGraphics;",
            "Keywords=stippling;dots;halftone;plotter;illustration;",
            f"MimeType={';'.join(_OPENED)};",
            f"StartupWMClass={APP_ID}",
            "StartupNotify=true",
            "",
        ]
    )


def _quoted(argument: str) -> str:
    """Quote an argument of Exec; a percent sign would begin a field code."""
    text = argument.replace("%", "%%")
    if not set(text) & set(" \t\n\"'\\><~|&;$*?#()`"):
        return text
    for character in '\\"`$':
        text = text.replace(character, f"\\{character}")
    return '"' + text.replace("\\", "\\\\") + '"'  # a string of the file is unescaped once more


_KIND = """<?xml version="1.0" encoding="UTF-8"?>
<mime-info xmlns="http://www.freedesktop.org/standards/shared-mime-info">
  <mime-type type="application/x-stipple">
    <comment>Stipple drawing</comment>
    <icon name="stippler"/>
    <magic priority="60">
      <match type="string" offset="30" value="mimetype">
        <match type="string" offset="38" value="application/x-stipple"/>
      </match>
    </magic>
    <glob pattern="*.stipple"/>
  </mime-type>
</mime-info>
"""
