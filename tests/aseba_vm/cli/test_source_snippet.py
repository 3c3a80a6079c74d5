from aseba_vm.cli.source_snippet import excerpt


def test_the_caret_is_under_the_column():
    assert excerpt("a\nbcd", 1, 2) == "bcd\n  ^"


def test_tabs_stay_tabs():
    assert excerpt("\tn = m", 0, 5) == "\tn = m\n\t    ^"


def test_a_place_after_the_end_is_the_end():
    assert excerpt("ab", 7, 9) == "ab\n  ^"


def test_a_long_line_is_cut_around_the_place():
    line, caret = excerpt("x" * 1000 + "!" + "x" * 1000, 0, 1000).split("\n")
    assert len(line) == 100
    assert line[caret.index("^")] == "!"


def test_control_characters_are_not_sent_to_the_terminal():
    assert excerpt("a\x1b[31mb\r", 0, 1) == "a?[31mb\n ^"


def test_only_the_caret_is_coloured():
    assert excerpt("ab", 0, 1, is_coloured=True) == "ab\n \x1b[31m^\x1b[0m"
