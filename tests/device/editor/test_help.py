"""The help of names: every language has all of them."""

from __future__ import annotations

import pytest

from thymio_sim_ros.device.editor.help import ENGLISH, TABLES

KINDS = ("variables", "natives", "events")


@pytest.mark.parametrize("language", sorted(TABLES))
@pytest.mark.parametrize("kind", KINDS)
def test_a_language_helps_with_every_name_and_no_other(language, kind):
    assert getattr(TABLES[language], kind).keys() == getattr(ENGLISH, kind).keys()


@pytest.mark.parametrize("language", sorted(TABLES.keys() - {"en"}))
@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_left_in_english(language, kind):
    english = getattr(ENGLISH, kind)
    assert [name for name, text in getattr(TABLES[language], kind).items() if text == english[name]] == []


@pytest.mark.parametrize("language", sorted(TABLES))
def test_help_is_one_line_without_a_full_stop(language):
    texts = [text for kind in KINDS for text in getattr(TABLES[language], kind).values()]
    assert [text for text in texts if "\n" in text or text.endswith(".") or not text] == []
