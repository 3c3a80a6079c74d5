"""Every state has a successor for all that can happen in it."""

from aseba_vm.jit.program_state import TRANSITIONS, Change, State


def test_bytecode_may_be_written_in_every_state():
    assert {state for state, change in TRANSITIONS if change is Change.WRITTEN} == set(State)


def test_every_state_can_be_reached_from_the_first():
    reached = {State.COLD}
    while more := {new for (old, _), new in TRANSITIONS.items() if old in reached} - reached:
        reached |= more
    assert reached == set(State)


def test_translated_code_runs_only_after_a_comparison():
    assert {old for (old, _), new in TRANSITIONS.items() if new is State.TRANSLATED} == {State.COLD, State.WRITTEN}
    assert TRANSITIONS[State.WRITTEN, Change.WRITTEN] is State.WRITTEN
