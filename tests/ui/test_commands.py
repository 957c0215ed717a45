"""Commands by name and by key, keys that a person chooses, and commands found by letters."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from stippler.editor.commands import CTRL, CTRL_SHIFT, Command, Commands, Key
from stippler.editor.events import KeyDown, Mods
from stippler.editor.fuzzy import match
from stippler.editor.keymap import FILE, is_modifier, load_keys, refusal, save_keys
from stippler.ui.popups.key_list import KeyList


def made(ran: list[str] | None = None) -> Commands:
    def note(name: str) -> Command:
        return Command(name, name.capitalize(), lambda: (ran or []).append(name))

    return Commands(
        [
            Command("work.relax", "Relax", lambda: (ran or []).append("relax"), (Key("l", CTRL),)),
            Command("edit.redo", "Redo", lambda: None, (Key("z", CTRL_SHIFT), Key("y", CTRL))),
            note("file.quit"),
        ]
    )


@pytest.mark.parametrize(
    ("key", "text"),
    [
        (Key("l", CTRL), "Ctrl+L"),
        (Key("f1"), "F1"),
        (Key("["), "["),
        (Key("page_up", Mods(alt=True)), "Alt+Page Up"),
        (Key("+", CTRL_SHIFT), "Ctrl+Shift++"),
        (Key("+"), "+"),
        (Key(",", CTRL), "Ctrl+,"),
        (Key(","), "Comma"),
        (Key("kp_add"), "Keypad Plus"),
        (Key("kp_enter", CTRL), "Ctrl+Keypad Enter"),
    ],
)
def test_a_key_is_read_as_it_is_written(key: Key, text: str) -> None:
    assert str(key) == text
    assert str(Key.read(text)) == text
    assert Key.read(text) == key


def test_keys_that_were_kept_as_the_system_names_them_are_read() -> None:
    assert Key.read("Kp_add") == Key("kp_add")


@pytest.mark.parametrize("text", ["", "Ctrl+", "Hyper+L", "Ctrl+Hyper+L"])
def test_what_is_no_key_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="no key"):
        Key.read(text)


def test_a_key_given_to_another_command_is_taken_from_the_first() -> None:
    ran: list[str] = []
    commands = made(ran)
    commands.bind("file.quit", (Key("l", CTRL), Key("y", CTRL)))
    assert commands["work.relax"].keys == ()
    assert commands["edit.redo"].keys == (Key("z", CTRL_SHIFT),)
    assert commands.take(KeyDown("l", CTRL))
    assert commands["file.quit"].hint == "File.quit (Ctrl+L)"
    assert commands.is_changed("work.relax")
    commands.reset("work.relax")
    assert commands.owner(Key("l", CTRL)) is commands["work.relax"]
    assert commands["file.quit"].keys == (Key("y", CTRL),)
    commands.reset_all()
    assert not any(commands.is_changed(command.name) for command in commands)
    assert commands.owner(Key("y", CTRL)) is commands["edit.redo"]


def test_chosen_keys_survive(tmp_path: Path) -> None:
    commands = made()
    commands.bind("file.quit", (Key("l", CTRL),))
    save_keys(tmp_path, commands)
    again = made()
    assert load_keys(tmp_path, again) == ""
    assert again["file.quit"].keys == (Key("l", CTRL),)
    assert again["work.relax"].keys == ()
    assert again["edit.redo"].keys == commands["edit.redo"].keys


@pytest.mark.parametrize(
    "keys",
    [
        {"file.quit": ["Ctrl+"]},
        {"file.quit": "Ctrl+Q"},
        {"file.quit": [3]},
        {"file.quit": ["Space"]},
        ["file.quit"],
    ],
)
def test_bad_keys_are_one_line_and_the_rest_is_used(tmp_path: Path, keys: object) -> None:
    if isinstance(keys, dict):
        keys = {"gone.command": ["F9"], **keys, "work.relax": ["F7"]}
    (tmp_path / FILE).write_text(json.dumps({"version": 1, "keys": keys}))
    commands = made()
    problem = load_keys(tmp_path, commands)
    assert FILE in problem
    assert "\n" not in problem
    assert commands["file.quit"].keys == ()
    assert commands["work.relax"].keys == ((Key("f7"),) if isinstance(keys, dict) else
                                           (Key("l", CTRL),))  # fmt: skip


def test_held_keys_are_no_commands() -> None:
    assert refusal(Key("space"))
    assert refusal(Key("escape"))
    assert refusal(Key("unknown"))
    assert not refusal(Key("space_bar"))
    assert is_modifier("left_shift")
    assert is_modifier("right_control")
    assert not is_modifier("left")


def ask(keys: KeyList, name: str) -> None:
    keys._asked = name


def test_a_key_in_use_is_told_before_it_is_taken() -> None:
    kept: list[int] = []
    commands, keys = made(), KeyList(lambda: kept.append(1))
    ask(keys, "file.quit")
    keys.take(KeyDown("left_control", CTRL), commands)  # only holds
    keys.take(KeyDown("l", CTRL), commands)
    assert keys.said == "Ctrl+L is used by Relax; it will have none."
    assert keys.waits
    keys.take(KeyDown("y", CTRL), commands)
    assert keys.said == "Ctrl+Y is used by Redo; it will have only Ctrl+Shift+Z."
    keys.take(KeyDown("space"), commands)
    assert "press another" in keys.said
    assert not kept
    keys.take(KeyDown("f8"), commands)
    assert not keys.waits
    assert kept == [1]
    assert commands["file.quit"].keys == (Key("f8"),)
    ask(keys, "file.quit")
    keys.take(KeyDown("escape"), commands)
    assert not keys.waits
    assert commands["file.quit"].keys == (Key("f8"),)


def test_groups_stand_in_the_order_of_the_menus() -> None:
    commands = Commands([Command(f"{name}.x", name, list) for name in ("zoo", "help", "file")])
    assert [group for group, _ in commands.groups()] == ["File", "Help", "Zoo"]


def best(typed: str, *texts: str) -> list[str]:
    scored = [(match(typed, text), text) for text in texts]
    fits = [(score, text) for score, text in scored if score is not None]
    return [text for _, text in sorted(fits, key=lambda fit: -fit[0])]


def test_letters_find_the_best_first() -> None:
    assert best("rel", "Free the selection", "Relax all dots", "Relax")[:2] == [
        "Relax",
        "Relax all dots",
    ]
    assert best("rad", "Reset a panel", "Relax all dots")[0] == "Relax all dots"  # initials
    assert best("all sel", "Select all", "Select nothing") == ["Select all"]  # any order
    assert best("DOT", "Relax all dots", "Quit") == ["Relax all dots"]
    assert match("xyz", "Relax") is None
    assert match("", "Relax") is not None
