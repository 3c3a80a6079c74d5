"""The languages: every folder fits English, the reference, and a new folder is a new language everywhere."""

from __future__ import annotations

import json
import os
import re
import shutil
import string
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from aseba_vm.languages import ENGLISH, LANGUAGES, texts
from web_ui import build

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "aseba_vm" / "languages"
PAGE = ROOT / "web_ui"
FILES = sorted(path.stem for path in (FOLDER / ENGLISH).glob("*.json"))
OTHERS = [language for language in LANGUAGES if language != ENGLISH]
COMPLETE = ("de", "fr", "it")
"""Languages that lack nothing; others may, and English is shown for what they lack."""


def own_texts(language: str, file: str) -> dict[str, str]:
    """The texts that the language itself has."""
    path = FOLDER / language / f"{file}.json"
    table: dict[str, str] = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    return table


def placeholders(text: str) -> list[str]:
    return sorted(re.findall(r"\{\w+\}", text))


# -- the folders -------------------------------------------------------------------------------------------------------


def test_every_folder_is_a_language() -> None:
    folders = sorted(path.name for path in FOLDER.iterdir() if path.is_dir() and path.name != "__pycache__")
    assert folders == sorted(LANGUAGES)
    assert [name for name in folders if not re.fullmatch(r"[a-z]{2}", name)] == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_folder_has_no_file_that_english_lacks(language: str) -> None:
    assert {path.name for path in (FOLDER / language).iterdir()} <= {f"{file}.json" for file in FILES}


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("file", FILES)
def test_a_file_is_one_text_per_line_in_the_order_of_english(language: str, file: str) -> None:
    table = own_texts(language, file)
    assert [key for key in table if key not in own_texts(ENGLISH, file)] == []
    assert list(table) == [key for key in own_texts(ENGLISH, file) if key in table]
    path = FOLDER / language / f"{file}.json"
    if path.is_file():
        assert path.read_text(encoding="utf-8") == json.dumps(table, indent=2, ensure_ascii=False) + "\n"


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("file", FILES)
def test_texts_have_content_and_the_placeholders_of_english(language: str, file: str) -> None:
    english = own_texts(ENGLISH, file)
    for key, text in own_texts(language, file).items():
        assert text.strip(), key
        assert "\n" not in text, key
        assert placeholders(text) == placeholders(english[key]), key


@pytest.mark.parametrize("language", LANGUAGES)
def test_sentences_of_the_compiler_are_templates_of_python(language: str) -> None:
    for key, text in own_texts(language, "compiler").items():
        fields = sorted(f"{{{field}}}" for _, field, _, _ in string.Formatter().parse(text) if field is not None)
        assert fields == placeholders(text), key


@pytest.mark.parametrize("language", COMPLETE)
@pytest.mark.parametrize("file", FILES)
def test_a_complete_language_has_every_text(language: str, file: str) -> None:
    assert own_texts(language, file).keys() == own_texts(ENGLISH, file).keys()


@pytest.mark.parametrize("language", OTHERS)
@pytest.mark.parametrize("file", ["compiler", "help", "language"])
def test_no_sentence_is_left_in_english(language: str, file: str) -> None:
    assert own_texts(language, file).items() & own_texts(ENGLISH, file).items() == set()


# -- typography --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("file", FILES)
def test_apostrophes_and_quotation_marks_are_typographic(language: str, file: str) -> None:
    """Straight quotes surround pieces of code only."""
    if (language, file) == ("en", "blockly_core"):
        return  # Blockly's own words, which `blockly_texts.test.js` compares with it
    opening, closing = {"de": "„“", "fr": "«»", "it": "«»"}.get(language, "“”")
    for key, text in own_texts(language, file).items():
        assert re.search(r"\w'\w", text) is None, key
        assert text.count(opening) == text.count(closing), key
        assert set(text) & set("„“”«»") <= {opening, closing}, key


@pytest.mark.parametrize("file", FILES)
def test_french_has_no_break_spaces_at_its_punctuation(file: str) -> None:
    for key, text in own_texts("fr", file).items():
        if key.startswith("skeleton."):
            continue  # comments of programs: pupils type plain spaces
        text = re.sub(r"&\w+;|%\d", "", text)  # entities of XML, places for values
        assert re.search(r"(?<!«)[ \xa0](?!!=)[;?!%]| :|« | »", text) is None, key
        assert re.search(r"[^\W\d]([;?!%]|:(?=\s))|\w»|«\w", text) is None, key


# -- the page ----------------------------------------------------------------------------------------------------------

PARTS = {
    "blockly": "blockly",
    "class_tab": "class",
    "classroom": "classroom",
    "creator": "creator",
    "editor": "editor",
    "examples": "examples",
    "hosts/share_host.js": "sharing",
    "missions": "missions",
    "playground/labels.js": "creator",
    "playground_tab/reasons.js": "creator",
    "playground_tab/refusal.js": "creator",
    "playground_tab": "playground",
    "program_tab/program_badge.js": "program",
    "program_tab/program_news.js": "program",
    "program_tab": "editor",
    "python": "editor",
    "robot_tab": "robot",
    "sharing": "sharing",
    "shell": "stage",
    "stage": "stage",
    "state/program_status.js": "program",
    "tour": "tour",
    "vpl": "vpl",
    "welcome": "welcome",
}
"""Folders and modules of the page, and the file of texts that `t` means there; elsewhere it is page.json."""
OTHER_FILES = {
    "editorText": "editor",
    "exampleText": "examples",
    "keysText": "keys",
    "pageText": "page",
    "playgroundText": "playground",
}
"""Names of the texts of other files."""


def texts_of(name: str) -> str:
    """The file of texts that `t` means in a module."""
    return next((file for start, file in PARTS.items() if name == start or name.startswith(f"{start}/")), "page")


def sources() -> Iterator[tuple[str, str]]:
    """Each module of the page: its path in the page's folder, and its text."""
    for path in sorted(PAGE.rglob("*.js")):
        relative = path.relative_to(PAGE)
        if relative.parts[0] not in {"node_modules", "dist", "i18n"} and path.name != "parser.js":
            yield relative.as_posix(), path.read_text(encoding="utf-8")


def test_every_text_that_the_page_names_exists() -> None:
    uses = {
        (name, file, key)
        for name, source in sources()
        for file, pattern in (
            (texts_of(name), r'\bt\("([^"]+)"'),
            *((file, rf'\b{word}\("([^"]+)"') for word, file in OTHER_FILES.items()),
            ("creator", r'\bword: "([^"]+)"'),
        )
        for key in re.findall(pattern, source)
    }
    assert len(uses) > 200
    assert {(name, file, key) for name, file, key in uses if key not in texts(file)} == set()


@pytest.mark.parametrize("file", sorted({"page", *PARTS.values(), *OTHER_FILES.values()}))
def test_the_page_uses_every_text(file: str) -> None:
    """A key occurs as a string, or fits a template string such as `button.${name}`."""
    everything = "\n".join(source for _, source in sources())
    names = set(re.findall(r"""["'`]([\w.]+)["'`]""", everything))
    skeletons = "".join(path.read_text() for path in PAGE.glob("editor/skeletons/*"))
    names |= set(re.findall(r"\{([\w.]+)\}", skeletons))
    templates = {
        template for template in re.findall(r"`([\w.${}]+)`", everything) if re.search(r"\w\.\$|\}\.\w", template)
    }
    parts = ("\\w+".join(map(re.escape, re.split(r"\$\{\w+(?:\.\w+)*\}", template))) for template in templates)
    fitting = re.compile("|".join(parts))
    assert [key for key in texts(file) if key not in names and not fitting.fullmatch(key)] == []


# -- a new language ----------------------------------------------------------------------------------------------------


def add_test_language(folder: Path) -> None:
    """Add a language of three texts, with a code that no language has, to a copy of the folders."""
    tables = {
        "language": {"name": "Zzish"},
        "page": {"stop": "Haltu"},
        "compiler": {"unknown-variable": "neniu variablo nomiĝas '{0}'"},
    }
    (folder / "zz").mkdir()
    for file, table in tables.items():
        (folder / "zz" / f"{file}.json").write_text(json.dumps(table), encoding="utf-8")


def test_a_language_that_lacks_texts_is_english_where_it_does(add_language) -> None:
    add_language("zz", compiler={"label-hint": "Konsilo"})
    assert texts("compiler", "zz") == texts("compiler") | {"label-hint": "Konsilo"}
    assert texts("help", "zz") == texts("help")
    assert texts("page", "xx") == texts("page", "../en") == texts("page")


@pytest.mark.process
def test_the_command_speaks_a_language_whose_folder_was_added(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "aseba_vm", tmp_path / "aseba_vm", ignore=shutil.ignore_patterns("__pycache__"))
    add_test_language(tmp_path / "aseba_vm" / "languages")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "LC_ALL": "zz.UTF-8"}

    def said(program: str) -> str:
        command = [sys.executable, "-m", "aseba_vm", "check", "-"]
        done = subprocess.run(
            command, input=program, cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8", check=False
        )
        return done.stderr

    assert "neniu variablo nomiĝas 'zzzz'" in said("zzzz = 1")
    assert "expected a name but found number 3" in said("var 3")


@pytest.mark.process
def test_the_page_offers_a_language_whose_folder_was_added(tmp_path: Path) -> None:
    node = build.find_node()
    if node is None or not (PAGE / "node_modules").is_dir():
        pytest.skip("the page cannot be built here")
    ignored = shutil.ignore_patterns("node_modules", "dist")
    shutil.copytree(PAGE, tmp_path / "web_ui", ignore=ignored)
    (tmp_path / "web_ui" / "node_modules").symlink_to((PAGE / "node_modules").resolve())
    shutil.copytree(FOLDER, tmp_path / "aseba_vm" / "languages")
    shutil.copytree(ROOT / "aseba_vm" / "aesl", tmp_path / "aseba_vm" / "aesl")
    without = build.digest(tmp_path / "web_ui")
    add_test_language(tmp_path / "aseba_vm" / "languages")
    assert build.digest(tmp_path / "web_ui") != without
    program = """
        import { LANGUAGES, translator } from "./i18n/index.js";
        const t = translator("zz");
        console.log(JSON.stringify([LANGUAGES.zz, t("stop"), t("theme.dark")]));
    """
    command = [str(node.folder / "node"), "--input-type=module", "--eval", program]
    done = subprocess.run(command, cwd=tmp_path / "web_ui", capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == ["Zzish", "Haltu", "Dark"]
    assert build.script(tmp_path / "web_ui", "build") == 0
    scripts = list((tmp_path / "web_ui" / "dist" / "assets").glob("*.js"))
    assert any("Zzish" in script.read_text(encoding="utf-8") for script in scripts)
