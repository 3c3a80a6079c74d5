from dataclasses import replace

import hypothesis
import pytest
from hypothesis import strategies as st

from aseba_vm import AeslError, aesl, compile
from aseba_vm.aesl import Network, Node, Plugin
from aseba_vm.aesl.network import select
from aseba_vm.messages import MESSAGES
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.vectors import SHIPPED

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
    assert compile(node.code, THYMIO_II, network.events, network.constants).words


def test_a_node_has_the_position_of_its_code():
    node = aesl.loads(FILE).nodes[0]
    assert node.place(0) == (6, 34)
    assert node.place(node.code.index("if")) == (7, 4)
    assert node.rows_in_file() == (6, 7, 8)


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
    ("text", "kind", "place"),
    [
        ("<network>\n  <event size='1'/>\n</network>", "aesl-attribute-missing", (2, 3)),
        ("<network>\n<constant name='a' value='1x'/></network>", "aesl-number", (2, 27)),
        ("<network><event name='a' size='-1'/></network>", "aesl-event-size", (1, 32)),
        ("<network>\n<nodes></network>", "xml-closing-tag", (2, 8)),
        ("", "xml-empty", (1, 1)),
        ("\n <network>\n<node name='a'>\n", "xml-unclosed", (4, 1)),
        ("var a", "xml-start", (1, 1)),
        ("<network>\n<node name='é'>\nif a < b then</node></network>", "xml-bare-mark", (3, 6)),
        ("<network>\n<node name='é'>\na = b & c</node></network>", "xml-bare-mark", (3, 7)),
        ("<network>\n<node name='é'>\nif a <b then</node></network>", "xml-bare-mark", (3, 6)),
        ("<network><node name='é'>a&</node></network>", "xml-bare-mark", (1, 26)),
        ("<network><node name='é'>a<</node></network>", "xml-bare-mark", (1, 26)),
        ("<network a='<'/>", "xml-bare-mark", (1, 13)),
        ("<network>\0</network>", "xml-character", (1, 10)),
        ("<network><!-- </network>", "xml-unfinished", (1, 10)),
        ("<network><event a='' a=''/></network>", "xml-attribute-twice", (1, 22)),
        ("<network/>\nx", "xml-after-end", (2, 1)),
        ("<network>&amp;&nothing;</network>", "xml-entity", (1, 15)),
        ("<network>&#0;</network>", "xml-entity", (1, 10)),
        ("<network><?xml version='1.0'?></network>", "xml-other", (1, 10)),
        ("<!DOCTYPE a [<!ENTITY b 'c'>]><network/>", "aesl-entity", (1, 14)),
        ("<!DOCTYPE a [<!ENTITY % b 'c'>]><network/>", "aesl-entity", (1, 14)),
        ("<!DOCTYPE a [<!ENTITY b SYSTEM '/etc/passwd'>]><network/>", "aesl-entity", (1, 14)),
        ("<!DOCTYPE a SYSTEM '/etc/passwd'><network>&b;</network>", "xml-entity", (1, 43)),
        ("<network>" + "\n" * aesl.MAX_CHARACTERS, "aesl-too-long", (999_992, 1)),
    ],
)
def test_a_wrong_file_is_refused_in_place(text, kind, place):
    with pytest.raises(AeslError) as caught:
        aesl.loads(text)
    error = caught.value
    assert (error.kind, (error.line, error.column)) == (kind, place)
    assert error.located("f") == f"f:{place[0]}:{place[1]}: {error}"


TWO = '<node name="a"/>\n'


@pytest.mark.parametrize(
    ("text", "kind", "place"),
    [
        ("<!DOCTYPE a SYSTEM '/etc/passwd'><network><node name='a'/></network>", "aesl-outer-document", (1, 1)),
        ("<!DOCTYPE a PUBLIC 'a' 'b'><network><node name='a'/></network>", "aesl-outer-document", (1, 1)),
        ("<notwork><node name='a'/></notwork>", "aesl-root", (1, 1)),
        ("<network>\n</network>", "aesl-no-node", (2, 1)),
        ("<network/>", "aesl-no-node", (1, 1)),
        (f"<network>\n{TWO * 65}</network>", "aesl-many-nodes", (66, 1)),
        ("<network><node name='a' nodeId='x'/></network>", "aesl-node-id", (1, 33)),
        ("<network><node name='a' nodeId='65536'/></network>", "aesl-node-id", (1, 33)),
        ("<network><node name='a' nodeId='1'/>\n<node nodeId='1' name='a'/></network>", "aesl-node-twice", (2, 15)),
        ("<network><event name='a' size='259'/></network>", "aesl-event-size", (1, 32)),
        ("<network><event name='' size='1'/></network>", "aesl-name", (1, 23)),
        ("<network><event name='1a' size='1'/></network>", "aesl-name", (1, 23)),
        ("<network><event name='a b' size='1'/></network>", "aesl-name", (1, 23)),
        ("<network><constant name='while' value='1'/></network>", "aesl-name", (1, 26)),
        ("<network><event name='a' size='1'/>\n<event size='2' name='a'/></network>", "aesl-event-twice", (2, 23)),
        (
            "<network><constant name='a' value='1'/>\n<constant name='a' value='1'/></network>",
            "aesl-constant-twice",
            (2, 17),
        ),
        ("<network><constant name='a' value='32768'/></network>", "aesl-constant-value", (1, 36)),
        ("<network><constant name='a' value='-32769'/></network>", "aesl-constant-value", (1, 36)),
        ("<network><keywords flag='yes'/></network>", "aesl-keywords", (1, 26)),
    ],
)
def test_strict_reading_rejects_what_the_reference_accepts(text, kind, place):
    aesl.loads(text)
    with pytest.raises(AeslError) as caught:
        aesl.loads(text, strict=True)
    error = caught.value
    assert (error.kind, (error.line, error.column)) == (kind, place)


@pytest.mark.parametrize(
    "text",
    [
        FILE,
        '<network><event name="a" size="0"/><event name="b" size="258"/><constant name="a" value="-32768"/>'
        '<constant name="b.c" value="32767"/><node name="a"/><node name="a"/><node name="a" nodeId="1"/>'
        '<node name="b" nodeId="1"/><node name="a" nodeId="{01234567-89ab-cdef-0123-456789abcdef}"/></network>',
    ],
)
def test_strict_reading_accepts_valid_files(text):
    assert aesl.loads(text, strict=True) == aesl.loads(text)


def test_every_error_about_a_file_states_what_was_found_and_expected():
    texts = {kind: text for kind, text in MESSAGES.items() if kind.startswith(("aesl-", "xml-"))}
    assert {kind for kind, text in texts.items() if not ("found" in text and "expected" in text)} == set()


@pytest.mark.parametrize("data", [b'<?xml version="1.0" encoding="nonsense"?><network/>', b"<network>\xff</network>"])
def test_bytes_that_are_no_text_are_refused(data):
    with pytest.raises(AeslError) as caught:
        aesl.loads(data)
    assert caught.value.kind in ("text-unknown-encoding", "text-undecodable")


# -- writing

KEPT = """<?xml version="1.0"?>
<!DOCTYPE aesl-source>
<!-- before --><network version='2'>
<?other tool?>
<unknown a="b"><event size="1" name="no"/></unknown> text
<event name = 'ping' color="red" size='01'></event><!-- ping -->
\t<event size="2" name="pong"/>

<constant name="A&#x42;" value=" 7 "/>
<keywords flag="true" />
<node name="thymio-II" nodeId="1" color='blue'><![CDATA[a < b]]><!-- c --> &#38; d
<mystery/><toolsPlugins version="3">
<ThymioBlockly >
<xml a='1'>  </xml></ThymioBlockly></toolsPlugins>
</node >
<node name="e-puck"/>
</network>
<!-- after -->
"""


@pytest.mark.parametrize("text", [FILE, KEPT, KEPT.replace("\n", "\r\n"), "<network/>", "<a><b/></a>\n"])
def test_what_was_read_is_written_byte_for_byte(text):
    assert aesl.dumps(aesl.loads(text)) == text
    assert aesl.dumps(aesl.loads(text.encode())) == text
    assert aesl.dumps(aesl.loads("\ufeff" + text)) == "\ufeff" + text


@pytest.mark.vectors("aseba-aesl")
def test_files_of_the_reference_are_written_byte_for_byte(vector):
    network = aesl.loads(vector["file"])
    assert aesl.dumps(network) == vector["file"]
    anew = aesl.dumps(replace(network, pieces=()))
    assert aesl.loads(anew) == network
    if vector["folder"] == SHIPPED and "\n\n\n<!--list of global events-->" in vector["file"]:
        assert anew == vector["file"], "an editor of the reference wrote this file"


def test_only_what_was_changed_is_written_anew():
    network = aesl.loads(KEPT)
    first = network.nodes[0]
    changed = replace(
        network,
        events=(("ping", 1), ("pang", 2), ("new", 0)),
        constants=(),
        nodes=(replace(first, code="x < y\n"), network.nodes[1]),
    )
    expected = (
        KEPT.replace('<event size="2" name="pong"/>', '<event size="2" name="pang"/>\n<event size="0" name="new"/>')
        .replace('<constant name="A&#x42;" value=" 7 "/>', "")
        .replace("<![CDATA[a < b]]><!-- c --> &#38; d\n<mystery/><tools", "x &lt; y\n<!-- c --><mystery/><tools")
        .replace("</toolsPlugins>\n</node >", "</toolsPlugins></node>")
    )
    assert aesl.dumps(changed) == expected
    assert aesl.loads(expected) == changed


def test_new_definitions_go_under_their_headings():
    text = aesl.dumps(Network(keywords=True, nodes=(Node("thymio-II", 1, "a"),)))
    changed = replace(aesl.loads(text), events=(("ping", 1),), constants=(("A", 2),))
    assert aesl.dumps(changed) == aesl.dumps(replace(changed, pieces=()))


NAMES = st.text("ab", min_size=1, max_size=2)
NETWORKS = st.builds(
    Network,
    st.lists(st.tuples(NAMES, st.integers(0, 3)), max_size=4).map(tuple),
    st.lists(st.tuples(NAMES, st.integers(-3, 3)), max_size=4).map(tuple),
    st.sampled_from((None, True, False)),
    st.lists(
        st.builds(
            Node,
            NAMES,
            st.integers(0, 3),
            st.text("a<&\n\r]>\"'é ", max_size=6),
            st.sampled_from(
                ((), (Plugin("a", "", "<a/>"),), (Plugin("a", "b", "<a><b/></a>"), Plugin("c", "", "<c/>")))
            ),
        ),
        max_size=3,
    ).map(tuple),
)


@pytest.mark.parametrize("text", [FILE, KEPT, KEPT.replace("\n", "\r\n"), "<network/>", "<a></a>"])
@hypothesis.given(network=NETWORKS)
def test_any_change_of_any_file_can_be_read_again(text, network):
    changed = replace(network, pieces=aesl.loads(text).pieces)
    again = aesl.dumps(changed)
    assert aesl.loads(again) == changed
    assert aesl.dumps(aesl.loads(again)) == again


@pytest.mark.parametrize(
    ("text", "offset", "place"),
    [
        ("<n><node name=''>ab\ncd</node></n>", 0, (0, 17)),
        ("<n><node name=''>ab\ncd</node></n>", -1, (0, 17)),
        ("<n><node name=''>ab\ncd</node></n>", 4, (1, 1)),
        ("<n><node name=''>ab\ncd</node></n>", 99, (1, 2)),
        ("<n><node name=''>ab\r\ncd</node></n>", 4, (1, 1)),
        ("<n><node name=''>a&lt;b</node></n>", 1, (0, 18)),
        ("<n><node name=''>a&lt;b</node></n>", 2, (0, 22)),
        ("<n><node name=''>a<!-- x\n -->b</node></n>", 1, (1, 4)),
        ("<n><node name=''>a<x y='1'/>b</node></n>", 1, (0, 28)),
        ("<n><node name=''>a<![CDATA[b<c]]>d</node></n>", 2, (0, 28)),
        ("<n><node name=''>a<![CDATA[b<c]]>d</node></n>", 4, (0, 33)),
        ("<n><node name='é'>\n<![CDATA[é < b]]></node></n>", 5, (1, 13)),
        ("<n><node name=''><![CDATA[b]]></node></n>", 0, (0, 26)),
        ("<n><node name=''/></n>", 0, (0, 18)),
    ],
)
def test_a_character_of_the_code_is_found_in_the_file(text, offset, place):
    assert aesl.loads(text).nodes[0].place(offset) == place


def test_rows_of_the_code_are_found_in_the_file():
    text = "<n>\n<node name=''>a\n<!--\n-->b\r\n<![CDATA[\nc\n]]><x>\n</x>\n</node></n>"
    assert aesl.loads(text).nodes[0].rows_in_file() == (1, 3, 4, 5, 7, 8)
    assert Node("a", code="a\nb").rows_in_file() == (0, 1)


# -- files of other programs


@pytest.mark.parametrize("strict", [False, True])
def test_a_missing_number_is_zero(strict):
    text = '<network><event name="e"/><constant name="N"/><node/></network>'
    network = aesl.loads(text, strict=strict)
    assert (network.events, network.constants) == ((("e", 0),), (("N", 0),))


@pytest.mark.parametrize("opening", ["<node>", "<node name=''>", "<node name=\"it's\" nodeId=''>", "<node nodeId=' '>"])
def test_a_node_needs_neither_name_nor_number(opening):
    text = f"<!DOCTYPE aesl-source>\r\n<network>{opening}a</node></network>"
    (node,) = aesl.loads(text, strict=True).nodes
    assert (node.node_id, node.code) == (0, "a")
    assert aesl.dumps(aesl.loads(text)) == text


@pytest.mark.parametrize(
    "data",
    [
        "\ufeff<network><node>é</node></network>".encode("utf-16-le"),
        "\ufeff<network><node>é</node></network>".encode("utf-16-be"),
        "<network><node>é</node></network>".encode("utf-16-le"),
        "<network><node>é</node></network>".encode("utf-16-be"),
        b'<?xml version="1.0" encoding="UTF-16"?>' + "<network><node>é</node></network>".encode(),
        "\ufeff<network><node>é</node></network>".encode(),
        '<?xml version="1.0" encoding="windows-1252"?><network><node>é</node></network>'.encode("cp1252"),
    ],
)
def test_the_encodings_of_other_writers_are_read(data):
    assert aesl.loads(data, strict=True).nodes[0].code == "é"


@pytest.mark.parametrize(
    ("names", "guessed", "others"),
    [
        (["thymio-II", "e-puck"], [], ["e-puck"]),
        (["Thymio_4 on PC", "e-puck3"], ["Thymio_4 on PC"], ["e-puck3"]),
        (["dummynode-0", "e-puck0"], ["dummynode-0", "e-puck0"], []),
        (["", "thymio-II", "x"], ["", "x"], []),
    ],
)
def test_nodes_are_selected_for_a_kind_of_device(names, guessed, others):
    selection = select(Network(nodes=tuple(map(Node, names))), {"thymio-II"})
    assert [node.name for node in selection.guessed] == guessed
    assert [node.name for node in selection.others] == others
    assert {node.name for node in selection.named} <= {"thymio-II"}
