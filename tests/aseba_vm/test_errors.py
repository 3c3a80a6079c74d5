import pickle

from aseba_vm import AeslError, AsebaError, CompileError, SourcePos


def test_an_error_is_located_from_one():
    error = CompileError("unknown-variable", ("x",), SourcePos(10, 2, 4))
    assert error.located("robot.aesl") == "robot.aesl:3:5: no variable is called 'x'"


def test_an_error_without_place_names_the_file_only():
    assert CompileError("bytecode-too-large").located("f").startswith("f: the compiled program")


def test_errors_have_one_base():
    assert issubclass(CompileError, AsebaError)
    assert issubclass(AeslError, AsebaError)


def test_errors_can_be_copied_between_processes():
    error = pickle.loads(pickle.dumps(CompileError("int16-range", (70000,), SourcePos(0, 0, 0))))
    assert (error.kind, error.arguments, error.pos) == ("int16-range", (70000,), SourcePos(0, 0, 0))


def test_a_place_moves_with_the_text_it_is_in():
    assert SourcePos(3, 0, 3).moved(10, 20) == SourcePos(3, 10, 23)
    assert SourcePos(9, 2, 3).moved(10, 20) == SourcePos(9, 12, 3)
