"""What is measured on every answer."""
