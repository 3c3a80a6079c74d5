"""Point clouds as arrays, under the name that course files import."""
