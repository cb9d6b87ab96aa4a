# Run at each build: cmake -D SOURCE=FOLDER -D FILE=version_git.cpp -P version_git.cmake
# Writes the revision of the sources in FOLDER, "-dirty" where files differ from it; empty if FOLDER is not that of a repository, as in an
# archive that was unpacked within another one. A file with the same content keeps its time, so that nothing is compiled again.
set(ENV{GIT_OPTIONAL_LOCKS} 0)  # a build does not write to the repository
set(SNAG_GIT "")
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-cdup RESULT_VARIABLE result OUTPUT_VARIABLE path_to_root OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET)
if(result STREQUAL "0" AND path_to_root STREQUAL "")
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=* OUTPUT_VARIABLE SNAG_GIT OUTPUT_STRIP_TRAILING_WHITESPACE
    ERROR_QUIET)
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/version_git.cpp.in ${FILE} @ONLY)
