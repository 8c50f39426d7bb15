"""Readers of mesh files, one module a format: from the bytes of a file to its content.

No reader takes memory for what a file merely announces: every count is compared with the bytes that
are there (:mod:`meshwright_core.io.readers.numbers`). What does not concern points, elements and
names is passed over; a file is called damaged only where what is needed is missing or contradicts
itself.
"""
