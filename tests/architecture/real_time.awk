# SPDX-License-Identifier: AGPL-3.0-or-later
# Reads headers and tests. Prints each function marked ARTUS_REALTIME that fewer ARTUS_RUNS_REALTIME run than it
# has declarations, each mark on a private function (what calls it is marked) and each run that does not
# call what it names. A pure virtual function is run by its overriders. Used by real_time.cmake.
function indent_of(line) { match(line, /^ */); return RLENGTH }
function scope_name(    i, name) {
  name = ""
  for (i = 1; i <= depth; ++i) name = name scope[i] "::"
  return name
}
function text_until(start, last,    text, line) {  # joins lines until one ends in ";" or "{", or "}" for short bodies
  text = start
  while (text !~ /[;{}]$/ && (getline line) > 0) text = text " " line
  return text
}
function balanced(start,    text, line, i, c, level) {  # the text up to the parenthesis that closes the first
  text = start
  for (;;) {
    level = 0
    for (i = index(text, "("); i <= length(text); ++i) {
      c = substr(text, i, 1)
      if (c == "(") ++level
      if (c == ")" && --level == 0) return substr(text, 1, i)
    }
    if ((getline line) <= 0) return text
    sub(/^ */, " ", line)
    text = text line
  }
}
FNR == 1 { depth = 0; header = FILENAME ~ /\.h$/ && FILENAME !~ /\/tests\// }
header && /^ *(class|struct) [A-Za-z_]+[^;]*$/ {
  while (depth > 0 && level[depth] >= indent_of($0)) --depth
  ++depth
  level[depth] = indent_of($0)
  scope[depth] = $2
  sub(/[^A-Za-z_0-9].*/, "", scope[depth])
  hidden[depth] = $1 == "class"
  next
}
header && depth > 0 && /^ *(public|protected|private):/ { hidden[depth] = $0 ~ /private/; next }
header && depth > 0 && /^ *}/ && indent_of($0) == level[depth] { --depth; next }
header && /ARTUS_REALTIME/ && !/^ *(\/\/|#)/ {
  text = text_until($0)
  where = FILENAME ":" FNR
  if (text ~ /= 0;$/) next
  name = text
  sub(/.*ARTUS_REALTIME/, "", name)
  if (name ~ /operator\[\]/) name = "operator[]"
  else { sub(/\(.*/, "", name); sub(/ *$/, "", name); sub(/.*[ *&]/, "", name) }
  name = scope_name() name
  if (depth > 0 && hidden[depth]) print where ": " name " is private: mark what calls it"
  ++declared[name]
  first[name] = where
  ++marks
}
/ARTUS_RUNS_REALTIME\(/ && !/^ *(\/\/|#)/ {
  where = FILENAME ":" FNR
  text = $0
  sub(/.*ARTUS_RUNS_REALTIME/, "", text)
  text = balanced(text)
  name = substr(text, 2, index(text, ",") - 2)
  sub(/^ */, "", name)
  called = name
  sub(/.*::/, "", called)
  rest = substr(text, index(text, ",") + 1)
  if (called == "operator[]" ? index(rest, "[") == 0 : index(rest, called "(") == 0)
    print where ": runs no " name
  ++run[name]
  at[name] = where
}
END {
  if (marks == 0) print "no function is marked ARTUS_REALTIME"
  for (name in declared)
    if (run[name] < declared[name])
      print first[name] ": " name " is not run (" run[name] + 0 " of " declared[name] ")"
  for (name in run)
    if (!(name in declared)) print at[name] ": " name " is not marked ARTUS_REALTIME"
}
