"""XML from strangers: a tree with lines, or one precise refusal."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.formats import xml_tree
from thymio_sim_ros.sim.formats.xml_tree import MAX_DEPTH, XmlError, parse


def refused(text: str | bytes) -> XmlError:
    with pytest.raises(XmlError) as caught:
        parse(text)
    return caught.value


def test_elements_know_their_lines_attributes_and_text() -> None:
    root = parse('<?xml version="1.0"?>\n<!DOCTYPE a>\n<a>\n <b c="1">text</b>\n</a>')
    (child,) = root.children
    assert (root.tag, child.tag, child.line, dict(child.attributes), child.text) == ("a", "b", 4, {"c": "1"}, "text")


def test_names_are_those_without_a_name_space_but_for_one() -> None:
    link = "http://www.w3.org/1999/xlink"
    root = parse(f'<s:a xmlns:s="urn:x" xmlns:any="{link}" s:b="1" s:href="#2" any:href="#3" b="4" xml:id="5"/>')
    assert (root.tag, root.attributes) == ("a", {"b": "4", "xlink:href": "#3"})


def test_attributes_in_the_name_space_of_svg_keep_it() -> None:
    root = parse('<a xmlns:s="http://www.w3.org/2000/svg" s:style="1" style="2"/>')
    assert root.attributes == {"svg:style": "1", "style": "2"}


@pytest.mark.parametrize("text", ["<a><b x='1>'/><c>t</c  ><d\n/><e></e><f>/></f><g><!-- / --></g></a>", "<a><b/></a>"])
def test_elements_know_where_they_begin_and_end(text: str) -> None:
    found = [text[each.offset : each.end] for each in parse(text).walk()]
    assert found[0] == text
    assert "".join(found[1:]) == text.removeprefix("<a>").removesuffix("</a>")


@pytest.mark.parametrize("declared", ["utf-8", "utf-16", "iso-8859-1", "ISO-8859-15", "windows-1252"])
def test_a_text_has_the_encoding_that_it_declares(declared: str) -> None:
    text = f'<?xml version="1.0" encoding="{declared}"?><a>Zoë</a>'
    assert xml_tree.text_of(text.encode(declared)) == (text, None)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-be"])
def test_a_text_without_a_declaration_is_in_unicode(encoding: str) -> None:
    assert xml_tree.text_of("<a>Zoë</a>".encode(encoding)) == ("<a>Zoë</a>", None)


@pytest.mark.parametrize("head", ["", '<?xml version="1.0" encoding="utf-8"?>'])
def test_a_text_that_is_not_in_its_encoding_is_read_as_older_programs_wrote_it(head: str) -> None:
    text = f"{head}<a>Zoë “</a>"
    assert xml_tree.text_of(text.encode("windows-1252")) == (text, "UTF-8")


def test_text_is_that_directly_in_an_element() -> None:
    root = parse("<a>1<b>2</b>3<c/><![CDATA[4]]></a>")
    assert (root.text, [element.text for element in root.walk()]) == ("134", ["134", "2", ""])


def test_broken_xml_is_refused_at_its_line() -> None:
    assert refused("<a>\n<b></a>").line == 2


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE a [<!ENTITY x "<b/>">]><a>&x;</a>',
        '<!DOCTYPE a [<!ENTITY x "yyyy"><!ENTITY z "&x;&x;">]><a>&z;</a>',
        f'<!DOCTYPE a [<!ENTITY x "{"y" * 1000}">]><a>{"&x;" * 101}</a>',
        '<!DOCTYPE a [<!ENTITY x "y"><!ATTLIST a b CDATA "c">]><a/>',
        '<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/hostname">]><a>&x;</a>',
        '<!DOCTYPE a [<!ENTITY % x SYSTEM "http://127.0.0.1/x.dtd"> %x;]><a/>',
    ],
)
def test_entities_are_refused(text: str) -> None:
    assert "entity" in refused(text).found


def test_entities_that_stand_for_plain_text_are_replaced() -> None:
    """As Illustrator declares them for namespaces."""
    text = """<?xml version="1.0"?>
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://127.0.0.1:9/svg11.dtd" [
    <!ENTITY ns_svg "http://www.w3.org/2000/svg">
    <!-- <!ENTITY side "9"> -->
    <!ENTITY side '10'>
]>
<svg xmlns="&ns_svg;" width="&side;">&side;&amp;<rect/></svg>"""
    for root in (parse(text), parse(text.encode())):
        assert (root.tag, root.attributes, root.text, root.line) == ("svg", {"width": "10"}, "10&", 7)
        assert root.children[0].tag == "rect"


def test_a_document_type_elsewhere_is_not_fetched() -> None:
    text = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://127.0.0.1:9/svg11.dtd"><svg/>'
    assert parse(text).tag == "svg"


@pytest.mark.parametrize(
    "text", ["", "text", "<a/><b/>", b"\xff\xff", b'<?xml version="1.0" encoding="nonsense"?><a/>']
)
def test_what_is_no_xml_is_refused(text: str | bytes) -> None:
    assert refused(text).line >= 1


def test_depth_and_number_of_elements_are_limited() -> None:
    assert "too deeply nested" in refused("<a>" * (MAX_DEPTH + 1)).found
    assert "too deeply nested" in refused("<a>" + "<b/>" * 100_001).found
