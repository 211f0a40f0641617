"""Common parts of the topics: records, measures, run times, figures, report and runner."""
