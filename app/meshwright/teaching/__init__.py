"""Lessons and exercises that check the answers. Needs neither Qt nor torch."""

from meshwright.teaching.exercises.example_meshes import patch
from meshwright.teaching.exercises.exercise import Exercise, exercise
from meshwright.teaching.exercises.result import Answer
from meshwright.teaching.exercises.solution import ExerciseSolution

__all__ = ["Answer", "Exercise", "ExerciseSolution", "exercise", "patch"]
