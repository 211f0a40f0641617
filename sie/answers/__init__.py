"""What a solution answers: each class reads the stages of the ones before it."""
