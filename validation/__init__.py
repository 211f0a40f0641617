"""Every claim of the project, computed anew by `python -m validation`; see `__main__`.

topics, topics.figures      what is computed, and its pictures
cases, kinked_contacts      contacts that are compared with many digits
appendix_equations          the equations of the paper's appendix
rounded_punch               strength and tension of the rounded punch by closed forms
rivals                      other methods, and the races
wrong_programs              programs with a known error
harness                     records, measures, run times, drawing, report
readme                      the README's table
"""
