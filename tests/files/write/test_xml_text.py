"""What is written as an attribute is read back as it was, by a parser of others."""

from xml.etree import ElementTree

from hypothesis import given
from hypothesis import strategies as st

from stippler.files.write.xml_text import quoted

xml_signs = st.characters(min_codepoint=32, max_codepoint=0xD7FF) | st.sampled_from("\t\n\r&<>\"'")


@given(st.text(xml_signs))
def test_any_text_is_read_back(text):
    found = ElementTree.fromstring(f"<g label={quoted(text)}/>")
    assert found.get("label") == text
