-- SPDX-License-Identifier: AGPL-3.0-or-later
-- The first form of the records.
CREATE TABLE person(id TEXT PRIMARY KEY, role TEXT NOT NULL CHECK(role IN ('learner','teacher','rater')),
  cohort TEXT NOT NULL);
CREATE TABLE scenario(hash TEXT PRIMARY KEY, name TEXT NOT NULL, level INTEGER NOT NULL, toml TEXT NOT NULL);
CREATE TABLE attempt(id TEXT PRIMARY KEY, person TEXT REFERENCES person(id) ON DELETE SET NULL,
  scenario TEXT NOT NULL REFERENCES scenario(hash), started TEXT NOT NULL, ended TEXT,
  mode TEXT NOT NULL CHECK(mode IN ('train','test','demo')), aided INTEGER NOT NULL, device TEXT, seed INTEGER,
  folder TEXT, duration REAL, passed INTEGER, score REAL);
CREATE TABLE metric_name(id INTEGER PRIMARY KEY, name TEXT NOT NULL, role TEXT NOT NULL, unit TEXT NOT NULL,
  definition TEXT NOT NULL, filter TEXT NOT NULL, version INTEGER NOT NULL, UNIQUE(name, role, version));
CREATE TABLE metric(attempt TEXT NOT NULL REFERENCES attempt(id) ON DELETE CASCADE,
  name INTEGER NOT NULL REFERENCES metric_name(id), value REAL, PRIMARY KEY(attempt, name)) WITHOUT ROWID;
CREATE TABLE event(attempt TEXT NOT NULL REFERENCES attempt(id) ON DELETE CASCADE, t REAL, kind TEXT, region TEXT,
  value REAL, text TEXT);
CREATE TABLE rating(attempt TEXT NOT NULL REFERENCES attempt(id) ON DELETE CASCADE,
  rater TEXT REFERENCES person(id) ON DELETE SET NULL, instrument TEXT, item TEXT, value REAL, blinded INTEGER, at TEXT);
CREATE TABLE comment(attempt TEXT NOT NULL REFERENCES attempt(id) ON DELETE CASCADE,
  person TEXT REFERENCES person(id) ON DELETE SET NULL, t REAL, text TEXT);
CREATE INDEX attempt_person ON attempt(person, started);
CREATE INDEX event_attempt ON event(attempt, t);
