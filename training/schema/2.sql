-- SPDX-License-Identifier: AGPL-3.0-or-later
-- What a group does in a scenario: each number's middle and spread.
CREATE TABLE norm(scenario TEXT NOT NULL REFERENCES scenario(hash), grp TEXT NOT NULL, metric TEXT NOT NULL,
  role TEXT NOT NULL, unit TEXT NOT NULL, version INTEGER NOT NULL, n INTEGER NOT NULL, mean REAL NOT NULL, sd REAL NOT NULL,
  p10 REAL NOT NULL, p50 REAL NOT NULL, p90 REAL NOT NULL, PRIMARY KEY(scenario, grp, metric, role)) WITHOUT ROWID;
