"""Asking for a file: by the system's dialog where there is one, else by a window of our own."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui
from imgui_bundle import portable_file_dialogs as native

from stippler.names import shown
from stippler.ui.widgets import Widgets

OPENED = (
    ".stipple", ".csv",
    ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp", ".gif", ".jp2", ".heic", ".heif",
    ".avif",
)  # fmt: skip
_PROGRAMS = ("zenity", "kdialog", "matedialog", "qarma")  # what the native dialogs need on Linux
_LISTED = 400
_WIDTH, _LIST_HEIGHT = 520.0, 240.0
_AROUND, _LEAST_LIST = 190.0, 54.0  # what stands around the list; it is no lower than that
_LOW = 330.0  # in a window that is no higher, title and endings are left out
POPUP = imgui.WindowFlags_.no_resize | imgui.WindowFlags_.no_title_bar


def has_native_dialogs() -> bool:
    """Return whether the system has a file dialog; without one, native dialogs say "cancelled"."""
    return not sys.platform.startswith("linux") or any(shutil.which(one) for one in _PROGRAMS)


@dataclass(slots=True)
class _Native:
    """A system dialog that is open."""

    asked: native.open_file | native.save_file
    take: Callable[[Path], None]

    def poll(self) -> bool:
        """Return whether it has been answered; pass the answer on."""
        if not self.asked.ready(0):
            return False
        result = self.asked.result()
        answer = result if isinstance(result, str) else "".join(result[:1])
        if answer:
            self.take(Path(answer))
        return True


@dataclass(slots=True)
class _Own:
    """Our own dialog: a path, and the files beside it."""

    title: str
    verb: str
    text: str
    endings: tuple[str, ...]
    take: Callable[[Path], None]
    writes: bool = False
    name: str = ""
    problem: str = ""
    fresh: bool = True
    listed: tuple[Path, tuple[Path, ...]] | None = None


class Dialogs:
    """The dialog that is open, if any; `draw` is called in every frame.

    Parameters
    ----------
    use_native : bool
        Whether to ask by the system's dialogs.
    """

    def __init__(self, *, use_native: bool) -> None:
        self._use_native = use_native
        self._native: _Native | None = None
        self._own: _Own | None = None
        self._confirm: tuple[Path, Callable[[Path], None]] | None = None
        self._asked: _Own | None = None  # what the question whether to replace goes back to

    @property
    def waiting(self) -> bool:
        """Whether a system dialog is open, which wakes nobody when it is answered."""
        return self._native is not None

    @property
    def is_open(self) -> bool:
        """Whether a dialog of any kind is open."""
        return bool(self._native or self._own or self._confirm)

    def ask_picture(self, folder: Path, take: Callable[[Path], None]) -> None:
        """Ask for a picture to open."""
        self.ask_file("Open a picture or a drawing", "Pictures and drawings", folder, OPENED, take)

    def ask_file(
        self,
        title: str,
        what: str,
        folder: Path,
        endings: tuple[str, ...],
        take: Callable[[Path], None],
    ) -> None:
        """Ask for a file to read."""
        if self.is_open:
            return
        if self._use_native:
            patterns = " ".join(f"*{ending}" for ending in endings)
            asked = native.open_file(title, str(folder), [what, patterns])
            self._native = _Native(asked, take)
        else:
            self._own = _Own(title, "Open", f"{folder}/", endings, take)

    def ask_open(
        self, title: str, folder: Path, endings: tuple[str, ...], take: Callable[[Path], None]
    ) -> None:
        """Ask for a file of some kinds to read."""
        if self.is_open:
            return
        if self._use_native:
            patterns = " ".join(f"*{ending}" for ending in endings)
            self._native = _Native(native.open_file(title, str(folder), [title, patterns]), take)
        else:
            self._own = _Own(title, "Open", f"{folder}/", endings, take)

    def ask_place(self, path: Path, endings: tuple[str, ...], take: Callable[[Path], None]) -> None:
        """Ask where to write a file, by its folder and name; whether to replace is not asked."""
        if self.is_open:
            return
        if self._use_native:
            patterns = " ".join(f"*{ending}" for ending in endings)
            asked = native.save_file(
                "Export the drawing", str(path), ["Drawings", patterns], native.opt.force_overwrite
            )
            self._native = _Native(asked, take)
        else:
            self._own = _Own(
                "Where to export to", "Choose", str(path), endings, take, writes=True,
                name=path.name,
            )  # fmt: skip

    def ask_replace(self, path: Path, take: Callable[[Path], None]) -> None:
        """Ask whether a file may be replaced."""
        self._confirm, self._asked = (path, take), None

    def _ask_output(
        self,
        title: str,
        verb: str,
        path: Path,
        endings: tuple[str, ...],
        take: Callable[[Path], None],
    ) -> None:
        if self.is_open:
            return
        if self._use_native:
            patterns = " ".join(f"*{ending}" for ending in endings)
            asked = native.save_file(
                title, str(path), ["Drawings", patterns], native.opt.force_overwrite
            )
            self._native = _Native(asked, lambda chosen: self._checked(chosen, take))
        else:
            self._own = _Own(
                title,
                verb,
                str(path),
                endings,
                lambda chosen: self._checked(chosen, take),
                writes=True,
            )

    def ask_save(self, path: Path, endings: tuple[str, ...], take: Callable[[Path], None]) -> None:
        """Ask where to save the drawing; a file that is there is not replaced unasked."""
        self._ask_output("Save the drawing", "Save", path, endings, take)

    def ask_outlines(
        self, path: Path, endings: tuple[str, ...], take: Callable[[Path], None]
    ) -> None:
        """Ask where to write outlines; a file that is there is not replaced unasked."""
        self._ask_output("Export areas", "Export", path, endings, take)

    def dismiss(self) -> None:
        """Close our own dialog without an answer; the system's is the person's to close."""
        self._own = self._confirm = None

    def draw(self, widgets: Widgets) -> None:
        """Draw the dialog that is open."""
        if self._native is not None and self._native.poll():
            self._native = None
        if self._own is not None:
            self._draw_own(widgets, self._own)
        if self._confirm is not None:
            self._draw_confirm(widgets, *self._confirm)

    def _checked(self, path: Path, take: Callable[[Path], None]) -> None:
        if path.exists():
            self._confirm = (path, take)
        else:
            take(path)

    # --- our own ----------------------------------------------------------------------------

    def _draw_own(self, widgets: Widgets, own: _Own) -> None:
        imgui.open_popup(own.title)
        center(_WIDTH * widgets.scale)
        if not imgui.begin_popup_modal(own.title, None, POPUP)[0]:
            return
        is_low = imgui.get_main_viewport().size.y < _LOW * widgets.scale
        if not is_low:
            widgets.heading(own.title)
        if own.fresh:
            imgui.set_keyboard_focus_here()
            own.fresh = False
        imgui.set_next_item_width(-1.0)
        entered, own.text = imgui.input_text(
            "##path",
            own.text,
            imgui.InputTextFlags_.enter_returns_true | imgui.InputTextFlags_.auto_select_all,
        )
        widgets.note("path")
        chosen = Path(own.text).expanduser() if entered and own.text.strip() else None
        chosen = _draw_list(widgets, own) or chosen
        if own.problem or not is_low:
            widgets.caption(
                own.problem or f"Endings: {', '.join(own.endings)}",
                widgets.theme.alarm if own.problem else None,
            )
        pressed, cancelled = _draw_verbs(widgets, own.verb)
        if pressed:
            chosen = Path(own.text).expanduser()
        is_file = chosen is not None and not chosen.is_dir()
        own.problem = _problem(own, chosen) if chosen is not None and is_file else own.problem
        if cancelled or (is_file and not own.problem):
            self._own, self._asked = None, own
            imgui.close_current_popup()
        imgui.end_popup()
        if chosen is not None and chosen.is_dir():
            own.text, own.fresh, own.problem = f"{chosen}/{own.name}", True, ""
        elif chosen is not None and not cancelled and not own.problem:
            own.take(chosen)

    def _draw_confirm(self, widgets: Widgets, path: Path, take: Callable[[Path], None]) -> None:
        title = "Replace the file?"
        imgui.open_popup(title)
        center(420.0 * widgets.scale)
        if not imgui.begin_popup_modal(title, None, POPUP)[0]:
            return
        widgets.heading(title)
        widgets.paragraph(f"{shown(path.name)} is there already.")
        widgets.caption(shown(path.parent))
        replaced, cancelled = _draw_verbs(widgets, "Replace")
        if replaced or cancelled:
            self._confirm = None
            imgui.close_current_popup()
        imgui.end_popup()
        if replaced:
            take(path)
        elif cancelled and self._asked is not None:
            self._own, self._asked.fresh = self._asked, True


def _problem(own: _Own, path: Path) -> str:
    """Return why a path cannot be taken, so that it can be mended; nothing where it can."""
    if own.writes and path.suffix.lower() not in own.endings:
        ending = f"{path.suffix} is no ending" if path.suffix else "An ending is missing"
        return f"{ending}; one of {', '.join(own.endings)}"
    if own.writes:
        return "" if path.parent.is_dir() else f"There is no folder {path.parent}"
    return "" if path.is_file() else f"{path.name} is not there"


def center(width: float) -> None:
    """Put the next window in the middle."""
    viewport = imgui.get_main_viewport()
    middle, most = viewport.get_center(), (0.96 * viewport.size.x, 0.96 * viewport.size.y)
    imgui.set_next_window_pos((middle.x, middle.y), imgui.Cond_.always, (0.5, 0.5))
    imgui.set_next_window_size((min(width, most[0]), 0.0))
    imgui.set_next_window_size_constraints((0.0, 0.0), most)


def _draw_verbs(widgets: Widgets, verb: str) -> tuple[bool, bool]:
    """Draw the verb and "Cancel" at the right; return which was pressed. Esc cancels."""
    width, gap = 104.0 * widgets.scale, 8.0 * widgets.scale
    imgui.dummy((0.0, 2.0 * widgets.scale))
    imgui.set_cursor_pos_x(imgui.get_window_width() - 2 * width - gap - widgets.margin)
    cancelled = widgets.button("Cancel", "Leave everything as it is.", width=width)
    imgui.same_line(0.0, gap)
    pressed = widgets.button(verb, f"{verb} this file.", width=width, primary=True)
    return pressed or widgets.entered(), cancelled or widgets.escaped()


def _draw_list(widgets: Widgets, own: _Own) -> Path | None:
    """List the folder of the path that is typed; return what was clicked twice."""
    typed = Path(own.text).expanduser()
    folder = typed if own.text.endswith("/") else typed.parent
    if own.listed is None or own.listed[0] != folder:
        own.listed = (folder, _contents(folder, own.endings))
    chosen = None
    room = imgui.get_main_viewport().size.y - _AROUND * widgets.scale
    height = min(_LIST_HEIGHT * widgets.scale, max(room, _LEAST_LIST * widgets.scale))
    imgui.begin_child("##files", (0.0, height), imgui.ChildFlags_.frame_style)
    if folder.parent != folder and imgui.selectable("..", False)[0]:
        own.text = f"{folder.parent}/".replace("//", "/") + own.name
    for path in own.listed[1]:
        label = f"{path.name}/" if path.is_dir() else path.name
        if imgui.selectable(label, path == typed, imgui.SelectableFlags_.allow_double_click)[0]:
            own.text = f"{path}/{own.name}" if path.is_dir() else str(path)
            if imgui.is_mouse_double_clicked(imgui.MouseButton_.left) and not path.is_dir():
                chosen = path
        widgets.note(label)
    imgui.end_child()
    return chosen


def _contents(folder: Path, endings: tuple[str, ...]) -> tuple[Path, ...]:
    """Return a folder's folders, then its files with one of the endings."""
    try:
        found = [path for path in folder.iterdir() if not path.name.startswith(".")]
        found = [path for path in found if shown(path) == str(path)]  # others cannot be typed
        folders = sorted(path for path in found if path.is_dir())
        files = sorted(path for path in found if path.suffix.lower() in endings and path.is_file())
    except OSError:
        return ()
    return tuple([*folders, *files][:_LISTED])
