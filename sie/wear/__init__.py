"""Where wear ends: the limit of fretting wear, and the modes of wear on a fixed width."""
