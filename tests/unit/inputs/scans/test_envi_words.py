"""Words of headers for the order of bytes and the type: what is not certain is None, so that it is refused."""

import pytest

from linepose.inputs.scans.envi_words import byte_order_of, data_type_of


@pytest.mark.parametrize(
    ("text", "order"),
    [
        ("0", 0),
        ("{1}", 1),
        ("1.0", 1),
        ("+1", 1),
        ("01", 1),
        ("0 = IEEE", 0),
        ("1 (network)", 1),
        ("Host (Intel)", 0),
        ("Network (IEEE)", 1),
        ("ieee-le", 0),
        ("ieee-be", 1),
        ("little endian", 0),
        ("MSB first", 1),
        ("IEEE", None),
        ("16", None),
        ("2", None),
        ("1.5", None),
        ("big or little", None),
    ],
)
def test_order_of_bytes(text, order):
    assert byte_order_of(text) == order


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("12", 12),
        ("12.0", 12),
        ("12 - unsigned integer", 12),
        ("4 (float32)", 4),
        ("uint16", 12),
        ("1-byte", 1),
        ("1 (byte)", 1),
        ("2-byte unsigned integer", None),
        ("4-byte integer", None),
        ("4 - byte integer", None),
        ("16-bit unsigned", None),
        ("8 bit", None),
    ],
)
def test_type_is_never_a_width(text, code):
    assert data_type_of(text) == code
