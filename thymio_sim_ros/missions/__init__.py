"""Missions: goals as data, judged in each tick on what the simulation knows (docs/missions.md).

facts         what is true or false in a tick: words of mission files
conditions    facts combined: all, any, not, once, then, hold, at most
mission       the values of a file
files         the files beside a mission, or those of a zip
free_zones    whether a robot can be in the zones
file_fields   fields and limits of a file
reader        reads a file; errors name the field
schema        the JSON schema of files, for editors
judge         a mission and an engine: checklist, stars, reasons
trial         a whole run of a program
check         whether solutions pass and start programs do not
shipped       the missions that are installed with the code, in order
live          a mission on an engine that runs live: tries, trouble
description   a mission and its try as JSON values
documents     the list of missions and their pictures, for the server of the page
lengths       how long a program is, in the unit of its language
"""

from __future__ import annotations

from thymio_sim_ros.missions.judge import Judge, State, Verdict
from thymio_sim_ros.missions.mission import Mission
from thymio_sim_ros.missions.reader import MissionError, load_mission

__all__ = ["Judge", "Mission", "MissionError", "State", "Verdict", "load_mission"]
