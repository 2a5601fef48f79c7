"""Reports of recorded sessions: one page per session, and one table for many."""
