"""The topics of the report: each computes records, and `figures` draws them."""
