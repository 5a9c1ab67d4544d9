from __future__ import annotations

import os

import pytest

from contactsim.files import write_atomically, write_text


def test_a_text_that_cannot_be_moved_into_place_leaves_the_old_one_and_no_other(tmp_path, monkeypatch):
    path = tmp_path / "folder" / "costs.json"
    write_text("old κ", path)

    def fail(*paths):
        raise OSError("disk full")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="disk full"):
        write_text("new", path)
    assert path.read_text(encoding="utf-8") == "old κ"
    assert list(path.parent.iterdir()) == [path]


def test_half_a_file_never_has_the_name_and_is_not_left(tmp_path):
    path, seen = tmp_path / "picture.png", []

    def save(file):
        file.write_bytes(b"half")
        seen.append((file.suffix, file.parent, path.exists()))
        raise MemoryError

    with pytest.raises(MemoryError):
        write_atomically(path, save)
    assert seen == [(".png", tmp_path, False)]
    assert list(tmp_path.iterdir()) == []
