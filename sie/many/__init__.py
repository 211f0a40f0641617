"""Contacts of one patch as arrays over many scenes."""
