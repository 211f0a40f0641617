"""What the topics share: records, measures, run times, figures, the report and its running."""
