"""The reader of pages: its blocks, files, commands, and the patterns for what they print."""

from __future__ import annotations

import re

import pytest

from tests import pages
from tests.pages import Command

PAGE = """\
# A page

Save it as `hello.py`; the name matters:

```python
print("hello")
```

The folder of `data/a.txt`, in text:

```
1
```

```console
$ python hello.py
hello
$ echo a \\
> b
a b
```

Nothing to save, as `x.py`: nothing.

```{toctree}
:maxdepth: 1
```

```console
# terminal 2
$ sleep 1000
$ ^C
```

```console
# terminal 2
...
more
```
"""


def test_the_blocks_of_a_page_have_their_language_line_and_paragraph() -> None:
    first, second, *rest = pages.all_blocks(PAGE)
    assert (first.language, first.text, first.line) == ("python", 'print("hello")\n', 5)
    assert first.before == "Save it as `hello.py`; the name matters:"
    assert (second.language, second.line) == ("", 11)
    assert [block.language for block in rest] == ["console", "{toctree}", "console", "console"]
    assert pages.blocks(PAGE, "python") == ['print("hello")\n']


def test_the_files_of_a_page_are_the_blocks_after_their_names() -> None:
    assert pages.files(PAGE) == {"hello.py": 'print("hello")\n', "data/a.txt": "1\n"}


def test_a_file_may_be_shown_twice_but_not_with_two_texts() -> None:
    assert len(pages.files(PAGE + "\n" + PAGE)) == 2
    with pytest.raises(pages.PageError, match=r"line 8: a second text for a\.py"):
        pages.files("`a.py`:\n\n```\n1\n```\n`a.py`:\n\n```\n2\n```\n")


def test_the_commands_of_a_block_have_what_they_print_and_their_terminal() -> None:
    first, second, third = (block for block in pages.all_blocks(PAGE) if block.language == "console")
    assert pages.commands(first) == [
        Command(1, "python hello.py", ("hello",), 16),
        Command(1, "echo a \\\nb", ("a b",), 18),
    ]
    assert pages.commands(second) == [Command(2, "sleep 1000", (), 31), Command(2, "^C", (), 32)]
    assert pages.commands(third) == [Command(2, "", ("...", "more"), 37)]


def test_a_block_that_begins_with_neither_command_nor_terminal_is_refused() -> None:
    (block,) = pages.all_blocks("\n\n```console\nhello\n```\n")
    with pytest.raises(pages.PageError, match=r"line 4: found 'hello', expected '\$ ' and a command"):
        pages.commands(block)


@pytest.mark.parametrize(
    ("printed", "output", "is_match"),
    [
        (["a"], "a\n", True),
        (["a"], "a\nb\n", False),
        (["a"], "", False),
        ([], "a\n", False),
        (["..."], "", True),
        (["..."], "a\nb\n", True),
        (["a", "...", "d"], "a\nb\nc\nd\n", True),
        (["a", "...", "d"], "a\nd\n", True),
        (["a", "...", "d"], "a\nb\n", False),
        (["x: 0.1...", "y"], "x: 0.123\ny\n", True),
        (["x: 0....", "y"], "x: 0.123\ny\n", True),
        (["x: ...", "y"], "x: 1\nz\ny\n", False),
        (["(.*)"], "a\n", False),
    ],
)
def test_gaps_stand_for_any_lines_or_any_text_of_a_line(printed: list[str], output: str, is_match: bool) -> None:
    assert (re.fullmatch(pages.pattern(printed), output) is not None) == is_match
