import pytest

from aseba_vm.aesl.text_decoding import decode
from aseba_vm.errors import TextError


@pytest.mark.parametrize(
    ("data", "text", "encoding"),
    [
        (b"", "", "utf-8"),
        ("é😀".encode(), "é😀", "utf-8"),
        (b"\xef\xbb\xbfvar a", "var a", "utf-8-sig"),
        ("é".encode("utf-16"), "é", "utf-16"),
        ('<?xml version="1.0" encoding="ISO-8859-1"?>é'.encode("latin-1"), None, "ISO-8859-1"),
    ],
)
def test_text_is_decoded_as_its_author_sees_it(data, text, encoding):
    file = decode(data)
    assert file.encoding == encoding
    assert file.text.endswith("é") if text is None else file.text == text
    assert file.encoded(file.text) == data


@pytest.mark.parametrize(
    ("data", "kind", "place"),
    [
        (b"a\n\xc3\xa9\xff", "text-undecodable", (2, 2)),
        (b"\xff\xfea", "text-undecodable", (1, 1)),
        (b'<?xml version="1.0" encoding="nonsense"?>', "text-unknown-encoding", (1, 1)),
        (b'<?xml version="1.0" encoding="hex"?>', "text-unknown-encoding", (1, 1)),
    ],
)
def test_a_file_that_is_no_text_is_refused_in_place(data, kind, place):
    with pytest.raises(TextError) as caught:
        decode(data)
    assert (caught.value.kind, (caught.value.line, caught.value.column)) == (kind, place)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_utf_16_without_a_mark_is_read(encoding):
    for text in ("var größe = 1", "<network>ö</network>"):
        assert decode(text.encode(encoding)).text == text
