# What CTest runs. `make test` reaches this file through build/CTestTestfile.cmake, which sets
#   build_folder   where programs and tests were built, relative to the project's root
#   patience       factor on all time limits, above 1 for slow builds
#
# Every tests/NAME.cpp is a doctest program, and each of its facts
#   TEST_CASE("a fact as a sentence") {
#   TEST_CASE("a fact about physics" * doctest::description("physics")) {
# becomes the CTest test "NAME.a fact as a sentence". The description is the label:
#   unit (the default, up to 60 s), physics or robust (300 s), figure (600 s), long (3600 s; run by
#   `make test-long` only). An exercise has the label exercise, and long too when it takes more than 10 s. Names may not contain , ; [ ] " \ * or ?, which mean something to CTest or doctest.
# All tests start in the root of the project, so that paths read as in the README.

get_filename_component(root "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)

set(time_unit 60)
set(time_physics 300)
set(time_robust 300)
set(time_figure 600)
set(time_long 3600)
set(time_notes 60)
set(time_exercise 300)
set(time_documented 60)

# Facts of functions run on two threads. Programs have one, where no fact says --threads: two facts run side by side
# on two cores, and threads that wait for each other there take three times as long.
function(describe_test name label)
    math(EXPR seconds "${time_${label}} * ${patience}")
    set(threads 1)
    if(label STREQUAL "unit")
        set(threads 2)
    endif()
    set_tests_properties("${name}" PROPERTIES
        LABELS "${label}"
        TIMEOUT "${seconds}"
        WORKING_DIRECTORY "${root}"
        ENVIRONMENT "OMP_NUM_THREADS=${threads};OMP_WAIT_POLICY=passive;LC_ALL=C.UTF-8")
endfunction()

# ---- the facts -----------------------------------------------------------------------------------
file(GLOB programs "${root}/tests/*.cpp")
foreach(source IN LISTS programs)
    get_filename_component(program "${source}" NAME_WE)
    file(READ "${source}" text)
    string(REGEX MATCHALL "TEST_CASE[A-Z_]*[(]" mentioned "${text}")
    string(REGEX MATCHALL "\nTEST_CASE[(][^{]*{" facts "${text}")
    list(LENGTH mentioned mentions)
    list(LENGTH facts registered)
    if(NOT mentions EQUAL registered)
        message(FATAL_ERROR "${source}: ${registered} of ${mentions} TEST_CASEs can be registered; "
            "each must begin a line, be a plain TEST_CASE(\"name\") and have no ; or [ in its name")
    endif()
    foreach(fact IN LISTS facts)
        string(REGEX REPLACE "\"[ \n]+\"" "" fact "${fact}")
        if(NOT fact MATCHES "^\nTEST_CASE[(][ \n]*\"([^],;\\\"*?[]+)\"([^{]*)[)] {$")
            message(FATAL_ERROR "${source}: a name may not contain , ; [ ] \" \\ * or ?:${fact}")
        endif()
        set(name "${CMAKE_MATCH_1}")
        string(REGEX REPLACE "[ \n]+" "" decorator "${CMAKE_MATCH_2}")
        set(label unit)
        if(decorator MATCHES "^[*](doctest::)?description[(]\"(unit|physics|robust|figure|long)\"[)]$")
            set(label "${CMAKE_MATCH_2}")
        elseif(decorator)
            message(FATAL_ERROR "${source}: the description of \"${name}\" is none of "
                "unit, physics, robust, figure, long:${decorator}")
        endif()
        add_test("${program}.${name}" "${root}/${build_folder}/tests/${program}" "--test-case=${name}")
        describe_test("${program}.${name}" "${label}")
        # doctest is content when no fact has the name that it was asked for.
        set_tests_properties("${program}.${name}" PROPERTIES FAIL_REGULAR_EXPRESSION "test cases: +0 ")
    endforeach()
endforeach()

# ---- files for others ----------------------------------------------------------------------------
add_test(openpmd.another_reader_finds_the_numbers sh tests/support/read_openpmd.sh "${build_folder}")
describe_test(openpmd.another_reader_finds_the_numbers physics)
set_tests_properties(openpmd.another_reader_finds_the_numbers PROPERTIES SKIP_RETURN_CODE 77)

# ---- the notes -----------------------------------------------------------------------------------
add_test(house.every_header_is_in_its_room sh tests/support/house.sh)
describe_test(house.every_header_is_in_its_room notes)
add_test(notes.code_and_numbers_are_fresh sh common/notes.sh check)
describe_test(notes.code_and_numbers_are_fresh notes)
add_test(notes.every_label_of_the_ledger_exists sh common/notes.sh ledger)
describe_test(notes.every_label_of_the_ledger_exists notes)
add_test(notes.every_link_leads_somewhere sh tests/support/links.sh)
describe_test(notes.every_link_leads_somewhere notes)
add_test(notes.the_book_has_no_broken_link sh -c
    "command -v pandoc > /dev/null && command -v node > /dev/null || exit 77; sh lecture_notes/book/build.sh html")
describe_test(notes.the_book_has_no_broken_link long)
set_tests_properties(notes.the_book_has_no_broken_link PROPERTIES SKIP_RETURN_CODE 77)
add_test(notes.the_contents_get_their_page_numbers sh tests/support/page_numbers.sh)
describe_test(notes.the_contents_get_their_page_numbers notes)
set_tests_properties(notes.the_contents_get_their_page_numbers PROPERTIES SKIP_RETURN_CODE 77)
add_test(notes.the_page_of_the_runs_says_what_they_say sh tests/support/validation.sh)
describe_test(notes.the_page_of_the_runs_says_what_they_say notes)
add_test(notes.every_formula_renders sh tests/support/formulas.sh)
describe_test(notes.every_formula_renders notes)
set_tests_properties(notes.every_formula_renders PROPERTIES SKIP_RETURN_CODE 77)
add_test(notes.numbers_agree_with_the_runs sh common/notes.sh compare)
describe_test(notes.numbers_agree_with_the_runs long)

# ---- pictures of any run -------------------------------------------------------------------------
foreach(what some own tools all)
    add_test(plot.${what} sh tests/support/plot_runs.sh "${build_folder}" ${what})
    describe_test(plot.${what} figure)
endforeach()
describe_test(plot.all long)
# ---- the pages for the browser (make test-web runs them) -------------------------------------------
add_test(pages.runs_and_sliders_are_those_of_the_programs sh tests/support/pages.sh ${build_folder})
describe_test(pages.runs_and_sliders_are_those_of_the_programs physics)

# ---- ranks (with the programs of make MPI=1 all) ---------------------------------------------------
foreach(what refuse memory.cic memory.explicit_em memory.implicit_moment bytes.cic bytes.explicit_em bytes.implicit_moment restart.cic restart.explicit_em restart.implicit_moment
        stop.cic stop.explicit_em stop.implicit_moment)
    string(REPLACE "." ";" fact ${what})
    add_test(ranks.${what} sh tests/support/ranks.sh "${build_folder}" ${fact})
    describe_test(ranks.${what} robust)
    set_tests_properties(ranks.${what} PROPERTIES SKIP_RETURN_CODE 77)
endforeach()

# ---- the exercises -------------------------------------------------------------------------------
# Each that runs something. Those with a patch build in one and the same copy of the sources.
add_test(exercises.each_has_a_solution sh common/exercise.sh check)
describe_test(exercises.each_has_a_solution notes)
add_test(exercises.answers_are_judged_or_refused sh tests/support/exercises.sh)
describe_test(exercises.answers_are_judged_or_refused exercise)
file(GLOB exercises "${root}/lecture_notes/exercises/[0-9]*.md")
foreach(exercise IN LISTS exercises)
    get_filename_component(id "${exercise}" NAME_WE)
    file(STRINGS "${exercise}" runs REGEX "^run ")
    file(STRINGS "${exercise}" patch REGEX "^patch:")
    file(STRINGS "${exercise}" seconds REGEX "^time: [0-9]+ s$")
    string(REGEX MATCH "[0-9]+" seconds "${seconds}")
    if(runs)
        add_test("exercise ${id}" sh -c "BUILD=${build_folder} sh common/exercise.sh test ${id}")
        if(patch OR seconds GREATER 10)
            describe_test("exercise ${id}" long)
            set_tests_properties("exercise ${id}" PROPERTIES LABELS "exercise;long")
        else()
            describe_test("exercise ${id}" exercise)
        endif()
        if(patch)
            set_tests_properties("exercise ${id}" PROPERTIES RESOURCE_LOCK patched_sources)
        endif()
    endif()
endforeach()

# ---- what the documentation says must run --------------------------------------------------------
# The commands `build/...` and `make ...` of README files and projects, and the lines  // Run:   build/...
# of program headers, each with --dry-run (which make understands as well).
file(GLOB documents "${root}/README.md" "${root}/*/README.md" "${root}/*/*.cpp"
    "${root}/*/*/*.cpp" "${root}/lecture_notes/exercises/projects-*.md")
foreach(document IN LISTS documents)
    file(RELATIVE_PATH where "${root}" "${document}")
    if(document MATCHES "[.]md$")
        file(STRINGS "${document}" lines REGEX "^ *(build/|make )")
    else()
        file(STRINGS "${document}" lines REGEX "^// Run: +build/")
    endif()
    foreach(line IN LISTS lines)
        string(REGEX REPLACE "^// Run:" "" command "${line}")
        string(REGEX REPLACE "#.*$" "" command "${command}")
        string(STRIP "${command}" command)
        set(name "documented.${command} (${where})")
        string(REGEX REPLACE "^build/" "${build_folder}/" command "${command}")
        add_test("${name}" sh -c "env -u MAKEFLAGS -u MAKELEVEL ${command} --dry-run")
        describe_test("${name}" documented)
    endforeach()
endforeach()
