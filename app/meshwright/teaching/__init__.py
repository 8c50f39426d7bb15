"""Teaching: exercises that check themselves. No Qt, no torch."""

from app.teaching.answer import Answer
from app.teaching.exercises import Exercise, exercise
from app.teaching.patches import patch
from app.teaching.solution import Solution

__all__ = ["Answer", "Exercise", "Solution", "exercise", "patch"]
