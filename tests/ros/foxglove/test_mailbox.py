"""Values from any thread for the thread of an executor."""

from __future__ import annotations

import threading

import pytest
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from tests.patience import Deadline
from thymio_sim_ros.ros.rclpy_ext.mailbox import Mailbox
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor


@pytest.fixture(params=[make_executor, lambda context: SingleThreadedExecutor(context=context)])
def executor(ros, request):
    """Each kind of executor, with its own node."""
    executor = request.param(ros.context)
    node = Node("mailbox", context=ros.context, start_parameter_services=False, enable_rosout=False)
    executor.add_node(node)
    yield executor, node
    executor.remove_node(node)
    executor.shutdown()
    node.destroy_node()


def test_values_of_another_thread_are_handled_in_order_in_the_executors(ros, executor):
    rotate, node = executor
    handled = []
    mailbox = Mailbox(node, lambda value: handled.append((value, threading.current_thread())))
    poster = threading.Thread(target=lambda: [mailbox.post(number) for number in range(1000)])
    poster.start()
    ros.until(lambda: rotate.spin_once(timeout_sec=0.05) or len(handled) == 1000)
    poster.join()
    assert handled == [(number, threading.current_thread()) for number in range(1000)]


def test_a_posted_value_wakes_the_executor(executor):
    rotate, node = executor
    handled = []
    mailbox = Mailbox(node, handled.append)
    rotate.spin_once(timeout_sec=0)
    threading.Timer(0, mailbox.post, ["bell"]).start()
    deadline = Deadline()
    while not handled:
        rotate.spin_once(timeout_sec=deadline.left_s)
        assert not deadline.is_over
    assert handled == ["bell"]


def test_a_value_posted_without_an_executor_waits_for_the_next_drain(ros):
    node = ros.make_node("alone")
    handled = []
    mailbox = Mailbox(node, handled.append)
    mailbox.post(1)
    mailbox.drain()
    assert handled == [1]


def test_a_full_mailbox_reports_it_and_accepts_more(ros):
    handled = []
    mailbox = Mailbox(ros.make_node("full"), handled.append, capacity=2)
    for number in range(3):
        assert mailbox.is_full() == (number == 2)
        mailbox.post(number)
    mailbox.drain()
    assert (handled, mailbox.is_full()) == ([0, 1, 2], False)


def test_a_closed_mailbox_handles_nothing(ros):
    handled = []
    mailbox = Mailbox(ros.make_node("closed"), handled.append)
    mailbox.close()
    mailbox.post(1)
    mailbox.drain()
    assert handled == []


def test_posting_to_an_executor_that_has_ended_is_harmless(ros):
    node = Node("late", context=ros.context, start_parameter_services=False, enable_rosout=False)
    executor = make_executor(ros.context)
    executor.add_node(node)
    mailbox = Mailbox(node, lambda value: None)
    executor.remove_node(node)
    executor.shutdown()
    mailbox.post(1)
    node.destroy_node()


def test_senders_are_served_in_turn_and_have_separate_limits(ros):
    handled = []
    mailbox = Mailbox(ros.make_node("fair"), handled.append, sender=lambda value: value[0], capacity=3)
    for number in range(3):
        mailbox.post((1, number))
    mailbox.post((2, 0))
    assert (mailbox.is_full(1), mailbox.is_full(2)) == (True, False)
    mailbox.drain()
    assert handled == [(1, 0), (2, 0), (1, 1), (1, 2)]
    assert not mailbox.is_full(1)


def test_large_values_fill_the_mailbox_sooner(ros):
    mailbox = Mailbox(ros.make_node("heavy"), lambda value: None, weight=lambda value: value, capacity=10)
    mailbox.post(9)
    assert not mailbox.is_full()
    mailbox.post(1)
    assert mailbox.is_full()


def test_a_flood_leaves_the_executor_time_for_others(executor):
    """Each handled value posts the next, so that the box is never empty."""
    rotate, node = executor
    others = []
    mailbox = Mailbox(node, lambda value: mailbox.post(value + 1), slice_s=0.001)
    rotate.spin_once(timeout_sec=0)
    mailbox.post(0)
    rotate.create_task(others.append, "served")
    for _ in range(20):
        rotate.spin_once(timeout_sec=1.0)
    assert others == ["served"]
    mailbox.close()
