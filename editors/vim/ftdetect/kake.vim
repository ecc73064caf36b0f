autocmd BufNewFile,BufRead *.kake setfiletype kake
