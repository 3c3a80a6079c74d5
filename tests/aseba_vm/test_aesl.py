import pytest

from aseba_vm import AeslError, aesl, compile
from aseba_vm.aesl import Network, Node, Plugin
from aseba_vm.targets import THYMIO_II

FILE = """<!DOCTYPE aesl-source>
<network>
<!--list of global events-->
<event size="1" name="ping"/>
<constant value="-4" name="SIZE"/>
<keywords flag="true"/>
<node nodeId="1" name="thymio-II">onevent ping
    if event.args[0] &lt; 3 then emit ping SIZE end
<toolsPlugins><ThymioVisualProgramming><vplroot a="&gt;"/></ThymioVisualProgramming><Empty/></toolsPlugins></node>
<unknown><thing/></unknown>
</network>
"""


def test_a_file_is_read():
    network = aesl.loads(FILE)
    assert network.events == (("ping", 1),)
    assert network.constants == (("SIZE", -4),)
    assert network.keywords is True
    node = network.nodes[0]
    assert (node.name, node.node_id) == ("thymio-II", 1)
    assert node.code.startswith("onevent ping\n    if event.args[0] < 3 then")
    assert node.plugins == (
        Plugin(
            "ThymioVisualProgramming",
            "vplroot",
            '<ThymioVisualProgramming><vplroot a="&gt;"/></ThymioVisualProgramming>',
        ),
        Plugin("Empty", "", "<Empty/>"),
    )
    assert network.others == ("<unknown><thing/></unknown>",)
    assert compile(node.code, THYMIO_II, network.events, network.constants).words


def test_a_node_knows_where_its_code_begins():
    node = aesl.loads(FILE).nodes[0]
    assert (node.row, node.col) == (6, 34)


@pytest.mark.parametrize(
    "xml", ["<a><a/></a>", "<a></a>", "<a/>", "<a>/></a>", '<a x="/>"></a >', "<a><b/><!-- /> --></a>"]
)
def test_data_of_plugins_are_kept_as_they_are(xml):
    network = aesl.loads(f'<network><node name="n">x<toolsPlugins>{xml}<a/></toolsPlugins></node></network>')
    assert [plugin.xml for plugin in network.nodes[0].plugins] == [xml, "<a/>"]


def test_what_is_written_is_read_again():
    network = aesl.loads(FILE)
    assert aesl.loads(aesl.dumps(network)) == network
    assert aesl.dumps(aesl.loads(aesl.dumps(network))) == aesl.dumps(network)


@pytest.mark.parametrize("code", ["", "\n", "a < b & c ]]> d", "a\r\nb\rc\td", "é😀", "<node>", "  x  "])
@pytest.mark.parametrize("name", ["thymio-II", "a\"b<c>'d", "--", "a\nb\tc"])
def test_any_text_survives(code, name):
    network = Network((("e", 0),), (("K", -1),), False, (Node(name, 7, code), Node(name, 8, "")))
    assert aesl.loads(aesl.dumps(network)) == network


def test_nodes_are_found_by_number_and_name():
    network = Network(nodes=(Node("a", 1, "x"), Node("b", 2, "y"), Node("a", 3, "z")))
    assert network.node("a", 3).code == "z"
    assert network.node("a", 2).code == "x"
    assert network.node("c") is None


def test_the_fork_writes_other_numbers_of_nodes():
    text = '<network><node nodeId="{5f8a}" name="thymio-II">a</node></network>'
    assert aesl.loads(text).nodes[0].node_id == "{5f8a}"


def test_bytes_are_decoded_as_they_declare():
    text = '<?xml version="1.0" encoding="ISO-8859-1"?><network><event size="1" name="été"/></network>'
    assert aesl.loads(text.encode("latin-1")).events == (("été", 1),)


@pytest.mark.parametrize(
    ("text", "reason", "place"),
    [
        ("<network>\n  <event size='1'/>\n</network>", "attribute name is missing", (2, 3)),
        ("<network>\n<constant name='a' value='1x'/></network>", "attribute value is not a number: '1x'", (2, 1)),
        ("<network>\n<nodes></network>", "mismatched tag", (2, 10)),
        ("", "no element found", (1, 1)),
    ],
)
def test_a_wrong_file_is_refused_in_place(text, reason, place):
    with pytest.raises(AeslError) as caught:
        aesl.loads(text)
    error = caught.value
    assert error.located("f") == f"f:{place[0]}:{place[1]}: {reason}"
    assert (str(error), (error.line, error.column)) == (reason, place)


def test_an_unknown_encoding_is_refused():
    with pytest.raises(AeslError):
        aesl.loads(b'<?xml version="1.0" encoding="nonsense"?><network/>')
