"""What convinces a sceptic: every claim computed anew. `python -m validation` runs all of it; see
`__main__`.
"""
