from aseba_vm.cli.source_snippet import source_snippet


def test_the_caret_is_under_the_column():
    assert source_snippet("a\nbcd", 1, 2) == "bcd\n  ^"


def test_tabs_stay_tabs():
    assert source_snippet("\tn = m", 0, 5) == "\tn = m\n\t    ^"


def test_a_place_after_the_end_is_the_end():
    assert source_snippet("ab", 7, 9) == "ab\n  ^"


def test_a_long_line_is_cut_around_the_place():
    line, caret = source_snippet("x" * 1000 + "!" + "x" * 1000, 0, 1000).split("\n")
    assert len(line) == 100
    assert line[caret.index("^")] == "!"


def test_control_characters_are_not_sent_to_the_terminal():
    assert source_snippet("a\x1b[31mb\r", 0, 1) == "a?[31mb\n ^"


def test_only_the_caret_is_coloured():
    assert source_snippet("ab", 0, 1, is_colored=True) == "ab\n \x1b[31m^\x1b[0m"
