"""A class on one machine: a suite for each pupil, and a page for the teacher (docs/classroom.md).

pupils        names from a CSV file
folder        what is kept: tokens, ports, programs
suite_process the suite of a pupil as a child process: start, end, why it has ended
bridge_client the connection to a suite: state, poses and program come in, pause and messages go out
seat          a pupil's place: supervises the suite, keeps the program
classroom     all seats, and what the teacher does to them
plan          a playground seen from above, for the small pictures
requests      the HTTP interface of the teacher's page, without I/O
address       where the class listens
router        the one port of the class: path → page, interface, or suite
suite_proxy   requests that are passed on to suites
server        the HTTP server
"""
