# Completes the options of tanktread, and after --set the keys of a deck and their allowed words.

_tanktread_keys() { # Section/key=word, or Section/key= where any value may follow
  tanktread --reference | awk -F'|' '
    /^## / { section = substr($0, 4); gsub(/`/, "", section) }
    /^\| `/ && section !~ /</ {
      key = $2; gsub(/^ *`|` *$/, "", key)
      count = split($4, words, "`")
      if (count < 3) print section "/" key "="
      for (i = 2; i <= count; i += 2) print section "/" key "=" words[i]
    }'
}

_tanktread() {
  local word=${COMP_LINE:0:COMP_POINT} before=${COMP_WORDS[COMP_CWORD - 1]} IFS=$'\n'
  word=${word##*--set }
  if [[ $word != "${COMP_LINE:0:COMP_POINT}" && $word != *" -"* ]]; then # the whole of a key, blanks and = included
    word=${word//[\'\"\\]/}
    local last=${COMP_WORDS[COMP_CWORD]} key
    COMPREPLY=()
    for key in $(_tanktread_keys); do
      [[ $key == "$word"* ]] && COMPREPLY+=("$(printf %q "${last//[\'\"\\]/}${key#"$word"}")")
    done
    compopt -o nospace
  elif [[ ${COMP_WORDS[COMP_CWORD]} == -* ]]; then
    COMPREPLY=($(compgen -W "$(tanktread --help | grep -o -- '--[a-z-]*' | sort -u)" -- "${COMP_WORDS[COMP_CWORD]}"))
  elif [[ $before == --new ]]; then
    COMPREPLY=($(compgen -W "$(tanktread --new '?' 2>&1 | sed 's/.*{\(.*\)}.*/\1/' | tr , '\n')" -- "${COMP_WORDS[COMP_CWORD]}"))
  elif [[ $before == --output || $before == --resume ]]; then
    COMPREPLY=($(compgen -d -- "${COMP_WORDS[COMP_CWORD]}"))
  else
    COMPREPLY=($(compgen -f -X '!*.@(yaml|xml)' -- "${COMP_WORDS[COMP_CWORD]}") $(compgen -d -- "${COMP_WORDS[COMP_CWORD]}"))
  fi
}

complete -o filenames -F _tanktread tanktread
