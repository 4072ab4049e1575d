# SPDX-License-Identifier: AGPL-3.0-or-later
# Says where a source file formatted by clang-format is too large: a file of more than 450 lines, a function
# of more than 60, a function of more than 6 parameters, and when half of the headers have more than 80 lines.
# A function begins with a statement that has a "(" and ends with "{", and ends with "}" at its indentation.
function indent_of(line) { match(line, /^ */); return RLENGTH }
function begins_with(text, words) { return text ~ ("^ *(" words ")([^A-Za-z0-9_]|$)") }
function count_parameters(text,    i, c, depth, angle, n, seen) {
  for (i = index(text, "("); i <= length(text); ++i) {
    c = substr(text, i, 1)
    if (c ~ /[({[]/ && ++depth == 1) continue
    if (c ~ /[])}]/ && --depth == 0) break
    if (c == "<") ++angle
    if (c == ">" && substr(text, i - 1, 1) != "-") --angle
    if (c == "," && depth == 1 && angle <= 0) ++n
    if (c != " ") seen = 1
  }
  return seen ? n + 1 : 0
}
function finish_file() {
  if (file == "") return
  if (lines > 450) print file ": " lines " lines, more than 450"
  if (file ~ /\.h$/) ++headers_of[lines > 500 ? 500 : lines]
  if (open) print file ":" start ": the end of this function was not found"
}
FNR == 1 { finish_file(); file = FILENAME; open = 0; head = ""; comment = 0 }
{
  lines = FNR
  if (open) {
    if (indent_of($0) == indent && $0 ~ /^ *}/) {
      if (FNR - start + 1 > 60) print file ":" start ": a function of " FNR - start + 1 " lines, more than 60"
      open = 0
    }
    next
  }
  text = $0
  if (comment || text ~ /^ *\/\*/) { comment = text !~ /\*\//; next }
  gsub(/\\"/, "", text)
  gsub(/"[^"]*"/, "\"\"", text)
  sub(/ *\/\/.*$/, "", text)
  sub(/ *\\$/, "", text)
  if (text ~ /^ *(#.*)?$/ || text ~ /^ *(public|private|protected):$/ || text ~ /^extern "" {$/) next
  if (head == "") { start = FNR; indent = indent_of(text) }
  head = head == "" ? text : head " " text
  if (text !~ /[;{}]$/) next
  is_function = head ~ /\(/ && head !~ /^ *{/ && (head ~ /operator/ || head !~ /^[^(]*=/) &&
    !begins_with(head, "using|return|static_assert|ARTUS_TRY|ARTUS_REQUIRE|ARTUS_ASSERT|ARTUS_FIELDS")
  if (is_function) {
    n = count_parameters(head)
    if (n > 6) print file ":" start ": a function of " n " parameters, more than 6"
    open = text ~ /{$/
  }
  head = ""
}
END {
  finish_file()
  for (i = 0; i <= 500; ++i) headers += headers_of[i]
  for (median = 0; median < 500 && 2 * below <= headers; ++median) below += headers_of[median]
  if (headers > 1 && median - 1 > 80) print "the headers' median is " median - 1 " lines, more than 80"
}
