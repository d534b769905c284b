"""How results look: trees and tables as text, in a terminal, as HTML and as pictures."""
