# SPDX-License-Identifier: AGPL-3.0-or-later
cmake_minimum_required(VERSION 3.25)
# A mutable object of ours with static storage lives in .data/.bss/.tdata/.tbss; constants live in .rodata and
# .data.rel.ro. Templates of other libraries keep such objects, too; those are theirs.
execute_process(COMMAND objdump -t -C ${LIB} OUTPUT_VARIABLE out COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE ";" "," out "${out}")
string(REPLACE "\n" ";" lines "${out}")
set(hits "")
foreach(line IN LISTS lines)
  if(line MATCHES " \\.(bss|data|tbss|tdata)[._A-Za-z0-9]*[\t ]+0*[1-9a-f][0-9a-f]* artus::"
      AND NOT line MATCHES "\\.data\\.rel\\.ro")
    list(APPEND hits "${line}")
  endif()
endforeach()
if(hits)
  string(REPLACE ";" "\n" hits "${hits}")
  message(FATAL_ERROR "mutable globals in ${LIB}:\n${hits}")
endif()
