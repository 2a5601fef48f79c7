"""Published values to see a session beside: the same as in the procedure panel of rviz and in docs/protocols.md.

None of them is a grade: they come from other tasks, people and methods, which `note` says.
"""

from dataclasses import dataclass

TREJOS = "Trejos et al., Surg Endosc 2011;25:186: instrument tip in transgastric procedures, two pigs"
COLONOSCOPE = "hand motion study with a colonoscope (Holden): medians"
SERIES = "Kumbhari et al., VideoGIE 2017, 10.1016/j.vgie.2017.01.002"


@dataclass(frozen=True)
class Reference:
    label: str
    measure: str  # key of the numbers of a session
    unit: str
    scale: float  # from SI to the unit
    digits: int
    expert: str = ""
    novice: str = ""
    other: str = ""  # a published range or limit that names no level of skill
    low: float = None  # of that range, in the unit
    high: float = None
    source: str = ""
    note: str = ""  # what is not comparable


REFERENCES = (
    Reference("Time", "time", "min", 1 / 60, 1, "0.5 (31.5 s)", "1.7 (101.5 s)", "at most 60; median 37", None, 60,
              COLONOSCOPE + "; 60 min: Kumbhari 2020; 37 min: 331 cases, Turjman, BJSTR 2023",
              "another task, only the ratio counts; 60 and 37 min are whole procedures with all that a simulator "
              "leaves out"),
    Reference("Bites in 5 min of suturing", "bites_per_5_min", "", 1, 1, "13.1 ± 5.2", "3.0 ± 0.8",
              "5.7 ± 2.8 (intermediate)", None, None, "simulator of endoscopic suturing, purse-string of 12 holes",
              "another simulator and another pattern; 7, 7 and 3 people"),
    Reference("Path of the tip", "path_length", "m", 1, 2, "shorter", "longer", "", None, None,
              "D'Angelo et al., Am J Surg 2015;209:645, 10.1016/j.amjsurg.2014.12.013",
              "no value is published for this task"),
    Reference("Smoothness, LDLJ", "log_dimensionless_jerk", "", 1, 2, "nearer to 0", "farther", "", None, None,
              "Hogan & Sternad, J Mot Behav 2009;41:529; separates attendings, residents and novices (hand motion)",
              "no value is published for this task; depends on the length of the movements"),
    Reference("Smoothness, SPARC", "spectral_arc_length", "", 1, 2, "nearer to 0", "farther", "", None, None,
              "Balasubramanian et al., J NeuroEng Rehabil 2015;12:112; smoother tool tip in endovascular tasks",
              "no value is published for this task"),
    Reference("Area of the body reduced by", "area_reduction", "%", 100, 1, "34.6", "9.4", "", None, None,
              "Surg Endosc 2022;36:5167, 10.1007/s00464-021-08893-1",
              "raters judged videos of a whole sleeve; here sections are measured"),
    Reference("Max force on the tool", "max_force", "N", 1, 2, "", "", "at most 8", 0, 8, TREJOS,
              "animals, another instrument"),
    Reference("Share of the time above 5 N", "share_above", "%", 100, 1, "", "", "1.6", 0, 1.6, TREJOS,
              "share of samples there"),
    Reference("Wall seen", "coverage", "%", 100, 1, "", "", "94 with a system that names blind spots, 78 without", None, None,
              "Wu et al., Gut 2019;68:2161, 10.1136/gutjnl-2018-317366: blind spots 5.86 and 22.46 %",
              "gastroscopies of patients, where 26 places count as seen or not; here the area"),
    Reference("Gas pressure at the end", "pressure", "mmHg", 1 / 133.322387415, 1, "", "", "10.0 (3.0 to 17.9)", 3, 17.9,
              "Ushimaru et al., Sci Rep 2020;10:18169, 80 patients", "during gastroscopy"),
    Reference("Suture sets", "sutures", "", 1, 0, "", "", "4 to 8", 4, 8,
              SERIES + " (6 to 8); BJSTR 2023 (5 to 6); Endosc Int Open 2020;8:E1349 (4 to 7)", "whole procedures"),
    Reference("Bites per set", "bites_per_set", "", 1, 1, "", "", "6 to 9", 6, 9, SERIES, ""),
    Reference("Bites off the body", "bites_off_body", "", 1, 0, "", "", "none", 0, 0,
              "antrum and fundus are spared: Updates Surg 2022, 10.1007/s13304-022-01385-4", ""),
    Reference("Sets that go proximally", "sets_proximal", "%", 100, 0, "", "", "all", 100, 100,
              "10.1177/26345161241289134", ""),
)


def verdict(reference, value):
    """"within", "outside" or "" where there is nothing to compare; `value` in the unit of the reference."""
    if value is None or reference.high is None:
        return ""
    low = reference.low if reference.low is not None else float("-inf")
    return "within" if low <= value <= reference.high else "outside"
