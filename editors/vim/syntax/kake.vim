" Scenes of kakeami. The words are those of grammar/kake.pest; a test holds both together.
if exists('b:current_syntax')
  finish
endif

syntax case match

" Words that begin a statement are words like any other elsewhere.
syntax match kakeStatement /^\s*\zs\<\%(edition\|import\|canvas\|seed\|let\|param\|field\|region\|tone\|fn\|paint\|outline\|ink\|layer\|for\|if\|experiment\)\>\ze\%(\s*[:,.)]\)\@!/
syntax match kakeClause /\<\%(as\|with\|in\|pen\|ink\|seed\)\>\ze\s\+\S/
syntax match kakeReserved /\<\%(and\|or\|not\|if\|then\|else\|match\)\>/
syntax keyword kakeBoolean true false
syntax match kakeLabel /\<\k\+\>\ze\s*:/
syntax match kakeNumber /\<\d\+\%(\.\d\+\)\=\%([eE][+-]\=\d\+\)\=\%(%\|\%(mm\|cm\|in\|pt\|px\|deg\|rad\|turn\)\>\)\=/
syntax match kakeColour /#\x\{3,8}\>/
syntax match kakeCall /\<\k\+\>\ze(/
syntax match kakeComment /\/\/.*$/
syntax match kakeDoc /\/\/\/\%(\/\)\@!.*$/
syntax region kakeComment start=/\/\*/ end=/\*\//
syntax match kakeEscape /\\\%(u{[^}"]\{,10}}\|.\)/ contained
syntax region kakeInterpolation matchgroup=kakeEscape start=/{/ end=/}/ contained oneline contains=kakeNumber,kakeCall,kakeReserved,kakeBoolean,kakeColour
syntax region kakeString start=/"/ end=/"/ oneline contains=kakeEscape,kakeInterpolation

highlight default link kakeStatement Statement
highlight default link kakeClause Keyword
highlight default link kakeReserved Conditional
highlight default link kakeBoolean Boolean
highlight default link kakeLabel Identifier
highlight default link kakeNumber Number
highlight default link kakeColour Constant
highlight default link kakeCall Function
highlight default link kakeComment Comment
highlight default link kakeDoc SpecialComment
highlight default link kakeEscape Special
highlight default link kakeString String

let b:current_syntax = 'kake'
