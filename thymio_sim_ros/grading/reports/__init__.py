"""Reports of a graded class: a table, files for learning platforms, a page for each submission."""
