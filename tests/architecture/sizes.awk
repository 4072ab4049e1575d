# SPDX-License-Identifier: AGPL-3.0-or-later
# Says where a source file formatted by clang-format is too large: a file of more than 450 lines, a function
# of more than 60, a function of more than 6 parameters. Prints a line for each; used by sizes.cmake.
# A function begins with a line at its indentation that opens "(" and whose statement ends with "{", and
# ends with "}" at the same indentation.
function indent_of(line) { match(line, /^ */); return RLENGTH }
function count_parameters(text,    i, c, depth, angle, n, seen) {
  i = index(text, "("); depth = 0; angle = 0; n = 0; seen = 0
  for (; i <= length(text); ++i) {
    c = substr(text, i, 1)
    if (c == "(" || c == "{" || c == "[") { ++depth; if (depth == 1) continue }
    if (c == ")" || c == "}" || c == "]") { --depth; if (depth == 0) break }
    if (c == "<") ++angle
    if (c == ">" && substr(text, i - 1, 1) != "-") --angle
    if (c == "," && depth == 1 && angle <= 0) ++n
    if (c != " ") seen = 1
  }
  return seen ? n + 1 : 0
}
FNR == 1 { if (file != "" && lines > 450) print file ": " lines " lines"; file = FILENAME; open = 0; head = "" }
{
  lines = FNR
  text = $0
  if (open) {
    if (text ~ /^ *}[;,)]*( *\/\/.*)?$/ && indent_of(text) == indent) {
      length_of = FNR - start + 1
      if (length_of > 60) print file ":" start ": a function of " length_of " lines"
      open = 0; head = ""
    }
    next
  }
  if (text ~ /^ *(\/\/|#|$)/) { next }
  sub(/ *\/\/.*$/, "", text)
  if (head == "") {
    if (text ~ /^ *(namespace|class|struct|union|enum|extern|public:|private:|protected:|template|using|return|if|for|while|switch|else|do|case)\y/ && text !~ /\(/) { next }
    head = text; start = FNR; indent = indent_of(text)
  } else {
    head = head " " text
  }
  if (text ~ /[;{}]$/) {
    if (head ~ /\(/ && head !~ /^ *(namespace|class|struct|union|enum|if|for|while|switch|return|using|ARTUS_|TEST|EXPECT|static_assert)\y/ && head !~ /^[^(]*=[^(]*/) {
      n = count_parameters(head)
      if (n > 6) print file ":" start ": a function of " n " parameters"
      if (text ~ /{$/ && head !~ /= *{$/) { open = 1; next }
    }
    head = ""
  }
}
END { if (lines > 450) print file ": " lines " lines" }
