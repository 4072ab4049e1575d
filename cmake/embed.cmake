# SPDX-License-Identifier: AGPL-3.0-or-later
# cmake -DIN=FILE -DOUT=HEADER -DNAME=kName -P embed.cmake: the bytes of a file as a constant.
file(READ ${IN} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE ${OUT} "#pragma once\nnamespace artus {\ninline constexpr unsigned char ${NAME}[] = {${bytes}};\n}\n")
