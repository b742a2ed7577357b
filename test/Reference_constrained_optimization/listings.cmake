# Checks that no C++ is shown that is not compiled: README's listing is an example to the letter, and
# the manual takes all of its from the examples.
#
#   cmake -D SOURCE=<root of the project> -P listings.cmake

file(READ "${SOURCE}/README.md" readme)
set(name quick_start.cpp)
file(READ "${SOURCE}/examples/Reference_constrained_optimization/${name}" example)
string(FIND "${readme}" "```cpp\n${example}```" position)
if(position EQUAL -1)
  message(SEND_ERROR "README.md does not show ${name} as it is")
endif()
string(REGEX MATCHALL "```(cpp|c\\+\\+)" listings "${readme}")
list(LENGTH listings number)
if(NOT number EQUAL 1)
  message(SEND_ERROR "README.md has ${number} listings in C++, of which one is compiled")
endif()

file(GLOB_RECURSE pages "${SOURCE}/doc/*.txt" "${SOURCE}/doc/*.md")
foreach(page IN LISTS pages)
  file(READ "${page}" text)
  # \code and ~~~ without a language mean C++
  if(text MATCHES "[\\@]code(\n|\\{\\.?(cpp|c\\+\\+)|[ \t])" OR text MATCHES "(```|~~~)(\\{\\.)?(cpp|c\\+\\+)")
    message(SEND_ERROR "${page} has a listing of its own; take it from an example by \\snippet")
  endif()
endforeach()
