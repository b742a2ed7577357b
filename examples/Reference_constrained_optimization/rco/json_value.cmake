# Prints the value at a path in a JSON file, and fails if the file is not JSON:
#   cmake -D FILE=report.json "-D PATH=before;minimum_angle" -P json_value.cmake
cmake_minimum_required(VERSION 3.19)
file(READ "${FILE}" text)
string(JSON value GET "${text}" ${PATH})
execute_process(COMMAND "${CMAKE_COMMAND}" -E echo "${value}")
